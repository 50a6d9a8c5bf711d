#!/usr/bin/env bash
# Golden hashes, keyframes and recordings in one build after another: a line for each says whether it agreed.
# Every build replays the recordings of those before it, and must write the same bytes. Ends with 1 when one differs.
#
# Arguments name the builds to take, as `debug native`; without any, all.
#
# aarch64 is cross-built and run by qemu, with the standard library of rustup where that has it, else of Debian.
set -uo pipefail
cd "$(dirname "$0")/.."
folder=${CARGO_TARGET_DIR:-target}/matrix
mkdir -p "$folder"
folder=$(realpath "$folder")
AEYE_EXCHANGE=$(mktemp -d)
export AEYE_EXCHANGE
trap 'rm -rf "$AEYE_EXCHANGE"' EXIT

arm=aarch64-unknown-linux-gnu
ran="golden hashes, map digests, keyframes, recordings"
differing=0

wanted=" $* "
# Whether a build was asked for.
asked() { [ "$wanted" = "  " ] || [[ "$wanted" == *" $1 "* ]]; }

# row FOLDER NAME SETTING... -- CARGO_ARGUMENT...: one build and its line.
row() {
    local place=$1 name=$2 began=$SECONDS settings=() result=agreed
    shift 2
    while [ "$1" != -- ]; do settings+=("$1"); shift; done
    shift
    local log=$folder/${name//[^a-z0-9]/-}.log
    settings+=("AEYE_BUILD=${name//[^a-z0-9]/-}" "CARGO_TARGET_DIR=$folder/$place")
    if ! {
        env "${settings[@]}" cargo test "$@" -p kernel -p replay --test golden --test stories --test resume --test exchange &&
            env "${settings[@]}" cargo test "$@" -p kernel -p replay --lib -- bundled:: recording::
    } >"$log" 2>&1; then
        result="DIFFERED (see $log)"
        differing=1
    fi
    local tests
    tests=$(awk '/^test result:/ { sum += $4 } END { print sum + 0 }' "$log")
    printf '| %-36s | %s: %4s tests, %4s s | %s |\n' "$name" "$ran" "$tests" $((SECONDS - began)) "$result"
}

# Debian's compiler and its standard library for aarch64.
debian() {
    [ -d "/usr/lib/rustlib/$arm" ] && return
    local sudo=sudo
    [ "$(id -u)" != 0 ] || sudo=
    $sudo dpkg --add-architecture arm64 && $sudo apt-get update -qq &&
        $sudo apt-get install -y -qq --no-install-recommends rustc-web libstd-rust-web-dev:arm64
}

# Settings with which cargo builds for aarch64, one a line; nothing where there is no standard library for it.
for_arm() {
    local triple=${arm//-/_}
    rustup target add $arm >/dev/null 2>&1 || {
        debian >&2 || return 1
        echo "RUSTC=/usr/bin/rustc"
    }
    echo "CARGO_TARGET_${triple^^}_LINKER=aarch64-linux-gnu-gcc"
    # Where arm64 packages are installed too, the loader would find their libc, which is not its own.
    local root=/usr/aarch64-linux-gnu
    echo "CARGO_TARGET_${triple^^}_RUNNER=qemu-aarch64-static -L $root -E LD_LIBRARY_PATH=$root/lib"
    echo "CC_$triple=aarch64-linux-gnu-gcc"
}

! asked release || row release "release" -- --release
! asked debug || row debug "debug" -- --profile dev
! asked o1 || row o1 "opt-level 1" CARGO_PROFILE_RELEASE_OPT_LEVEL=1 -- --release
! asked native || row native "target-cpu=native" RUSTFLAGS="-C target-cpu=native" -- --release
if asked nehalem && [ "$(uname -m)" = x86_64 ]; then
    row release "x86-64 without AVX (qemu, Nehalem)" \
        CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_RUNNER="qemu-x86_64-static -cpu Nehalem" -- --release
fi
if ! asked arm; then
    :
elif settings=$(for_arm); then
    mapfile -t settings <<<"$settings"
    row arm "aarch64 (qemu)" "${settings[@]}" -- --release --target $arm
else
    printf '| %-36s | %s | NOT RUN: no standard library for it |\n' "aarch64 (qemu)" "$ran"
    differing=1
fi
exit $differing
