#!/usr/bin/env bash
# What takes too long for every `make test`. When all of it passes, docs/check-long.txt says when, of
# which commit, and how long each part took.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ -n "$(git status --porcelain)" ]; then
    echo "check-long: what it says is said of a commit; there are changes that are in none" >&2
    exit 1
fi
commit=$(git rev-parse HEAD)
passed=""
for part in oracles bench kills properties headless-test; do
    started=$SECONDS
    make --no-print-directory "$part"
    passed+=$(printf '%-10s passed in %d s' "$part" $((SECONDS - started)))$'\n'
done
{
    echo "What \`make check-long\` passed last."
    echo
    echo "date     $(date -u +%F)"
    echo "commit   $commit"
    printf '%s' "$passed"
} >docs/check-long.txt
cat docs/check-long.txt
