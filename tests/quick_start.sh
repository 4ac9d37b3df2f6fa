#!/usr/bin/env bash
# What tools/demo.sh takes on a bare Debian 12: packages, disk, processor seconds. Runs as root, which debootstrap and
# chroot need; everything happens in FOLDER, which goes at the end unless REEB_KEEP is set. A FOLDER that holds a bare
# Debian 12 already is used as it is. Usage: tests/quick_start.sh FOLDER [MIRROR]
set -euo pipefail
cd "$(dirname "$0")/.."

folder=$1
mirror=${2:-http://deb.debian.org/debian}
[[ -e $folder/etc/debian_version ]] || debootstrap --variant=minbase bookworm "$folder" "$mirror" >/dev/null
[[ -n ${REEB_KEEP:-} ]] || trap 'rm -rf --one-file-system "$folder"' EXIT

installed() { chroot "$folder" dpkg-query -W -f='${Package}\n' | wc -l; }
megabytes() { du -sm --one-file-system --exclude=./src "$folder" | cut -f1; }

mkdir -p "$folder/src"
git archive HEAD | tar -x -C "$folder/src"
cp /etc/resolv.conf "$folder/etc/resolv.conf"
packages=$(installed)
disk=$(megabytes)
TIMEFORMAT="%U %S"
exec 3>&1
taken=$({ time chroot "$folder" /bin/bash -c "cd /src && tools/demo.sh" >&3 2>&3; } 2>&1)
echo "packages: $(($(installed) - packages))"
echo "disk: $(($(megabytes) - disk)) MB of packages, $(du -sm "$folder/src" | cut -f1) MB of sources, build and demo"
awk '{printf "processor time: %.0f s\n", $1 + $2}' <<<"$taken"
