#!/usr/bin/env bash
# Makes the pictures of drives on docs/maps.md anew: what both drivers see in 2 min on each map, at chosen seconds.
#
# Usage: drives.sh AEYE
set -euo pipefail
aeye=$(realpath "$1")
cd "$(dirname "$0")/maps/drives"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# pictures MAP SEED:SECOND...: the first one becomes MAP-1.png, and so on.
pictures() {
	local map=$1 number=0 place seed
	shift
	for place in "$@"; do
		seed=${place%:*}
		number=$((number + 1))
		if [ ! -d "$work/$map-$seed" ]; then
			"$aeye" drive --headless --map "$map" --seed "$seed" --checkpoint truth --max-time 2m --record "$work/$map-$seed.mcap"
			"$aeye" rerender "$work/$map-$seed.mcap" --checkpoint truth --last 116s --fps 1 --size 480x240 --out "$work/$map-$seed"
		fi
		cp "$(printf '%s/%s-%s/%s-%s/rgb/%08d.png' "$work" "$map" "$seed" "$map" "$seed" $((60 * ${place#*:})))" "$map-$number.png"
	done
}

pictures city 5:70 6:65 6:70
pictures old_town 5:55 5:100 6:55
pictures suburb 5:50 5:80 6:30
pictures ring 5:15 5:30 6:45
pictures rural 5:10 5:75 6:65
pictures motorway 5:15 5:25 6:30
pictures lakeside 7:93 7:109 8:93
