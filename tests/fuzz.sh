#!/usr/bin/env bash
# Hunts for files that a parser cannot cope with: every test that damages files, for so many minutes each (20
# unless told) or a million cases, two at a time. tests/fuzz.sh [MINUTES [NAME...]]; a NAME is a part of a test's.
# What was found lies below target/fuzz, with what was said about it.
set -euo pipefail
cd "$(dirname "$0")/.."
export AEYE_FUZZ_MINUTES=${1:-20}
shift || true
export FOUND=${CARGO_TARGET_DIR:-$PWD/target}/fuzz
mkdir -p "$FOUND"

# Lines of "PACKAGE'S FOLDER|BINARY|TEST".
tests() {
    cargo test --release --workspace --no-run --message-format json --test it --test mutations --lib |
        sed -n 's/.*"manifest_path":"\([^"]*\)\/Cargo.toml".*"executable":"\([^"]*\)".*/\1|\2/p' |
        grep -E '/(it|mutations|perception|base)-[0-9a-f]+$' |
        while IFS='|' read -r folder binary; do
            "$binary" --list --format terse 2>/dev/null | sed -n 's/: test$//p' |
                grep -E '^(damaged_files::(logs|pictures|texts)::|(models::)?fuzz::|a_changed_map)' |
                sed "s#^#$folder|$binary|#"
        done
}

hunt() {
    IFS='|' read -r folder binary test <<<"$1"
    name=${test//::/-}
    scratch=$(mktemp -d -p "$([ -d /dev/shm ] && echo /dev/shm || echo "${TMPDIR:-/tmp}")" fuzz-XXXXXX)
    cd "$folder"
    if TMPDIR=$scratch "$binary" --exact "$test" --nocapture >"$FOUND/$name.log" 2>&1; then
        grep -a ' cases in ' "$FOUND/$name.log" || true
        rm -rf "$scratch"
    else
        rm -rf "${FOUND:?}/$name" && cp -r "$scratch" "$FOUND/$name" && rm -rf "$scratch"
        echo "FOUND by $test, see $FOUND/$name and its .log"
        exit 1
    fi
}
export -f hunt

tests | { if [ $# -gt 0 ]; then grep -E "$(IFS='|'; echo "$*")"; else cat; fi } |
    xargs -d '\n' -P "${AEYE_FUZZ_JOBS:-2}" -I{} bash -c 'hunt "$1"' _ {}
