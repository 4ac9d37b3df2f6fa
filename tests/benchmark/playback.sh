#!/usr/bin/env bash
# Plays 100,000 vertices and 2,000 frames, generated, with the C example, within 300 MiB of the whole process (resident,
# as the system counts it). Usage: tests/benchmark/playback.sh [BUILD_FOLDER [fast]]
set -euo pipefail
cd "$(dirname "$0")/../.."

build=${1:-build}
file=$(mktemp --suffix=.reeb)
trap 'rm -f "$file"' EXIT
"$build/tests/benchmark/long_stream" "$file" ${2:+"$2"}
python3 - "$build/examples/player" "$file" <<'END'
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
print(f"{peak:.0f} MiB resident at most")
sys.exit(peak > 300)
END
