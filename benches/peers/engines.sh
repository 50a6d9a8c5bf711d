#!/usr/bin/env bash
# Times the bundled networks from picture to mask against onnxruntime in one process; with TORCH=1 also networks of thirteen
# forms, which PyTorch exports with random weights.
#
# Usage: engines.sh PICTURE_TO_MASK FOLDER [ROUNDS]
# PICTURE_TO_MASK is the program of `benches`; below FOLDER go a Python environment, which holds the library of onnxruntime,
# and the exported networks.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "$1")
rounds=${3:-31}
mkdir -p "$2"
folder=$(cd "$2" && pwd)
python=$folder/engines/bin/python

python3 -m venv --clear "$folder/engines"
"$python" -m pip install --quiet --disable-pip-version-check --requirement "$here/engines.txt"
ORT_DYLIB_PATH=$(echo "$folder"/engines/lib/python*/site-packages/onnxruntime/capi/libonnxruntime.so.*)
export ORT_DYLIB_PATH
"$program" 256 128 "$rounds" "$here"/../../perception/checkpoints/*.onnx
if [ -n "${TORCH:-}" ]; then
	"$python" -m pip install --quiet --disable-pip-version-check torch==2.15.0 onnx==1.23.2
	"$python" "$here/architectures.py" "$folder/architectures" 512 256
	"$program" 512 256 "$rounds" "$folder"/architectures/*.onnx
fi
