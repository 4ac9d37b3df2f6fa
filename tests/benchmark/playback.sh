#!/usr/bin/env bash
# Plays 100,000 vertices and 2,000 frames, generated, forwards and backwards with the C example, and fails where the
# whole process takes more than 300 MiB (resident, as the system counts it). With `small`: 32,000 vertices and 400 frames,
# within as much less and 5 MiB for what no mesh has to do with. (What rows learn is then still a block of memory that
# glibc gives back to the system, and does not keep for each thread.)
# Usage: tests/benchmark/playback.sh [BUILD_FOLDER [main|fast [small]]]
set -euo pipefail
cd "$(dirname "$0")/../.."

build=${1:-build}
profile=${2:-main}
around=400 across=250 groups=80 decoder=288 process=300  # the last two in MiB
[[ ${3:-} != small ]] || { around=320 across=100 groups=16 decoder=92 process=101; }
file=$(mktemp --suffix=.reeb)
trap 'rm -f "$file"' EXIT
"$build/tests/benchmark/long_stream" "$file" "$profile" $around $across $groups
echo "generated in $SECONDS s"
python3 - "$process" "$build/examples/player" "$file" 1 "$decoder" <<'END_PYTHON'
import resource, subprocess, sys
subprocess.run(sys.argv[2:], check=True)
peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
print(f"{peak:.1f} MiB resident at most, of {sys.argv[1]}")
sys.exit(peak > float(sys.argv[1]))
END_PYTHON
echo "done in $SECONDS s"
