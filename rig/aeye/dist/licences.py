"""Prints the licences of the libraries in the program, from the sources that cargo has of them.

Usage: licences.py TARGET [FEATURES...]
"""

import json
import pathlib
import re
import subprocess
import sys

# Fonts have theirs beside them; those of libraries in C lie in the folders that are compiled.
LICENCE = re.compile(r"([^/]*(licen[cs]e|copying|notice|copyright)[^/]*|fonts/[^/]*\.txt)$", re.IGNORECASE)
CODE = {".c", ".h", ".json", ".py", ".rs", ".toml", ".ttf"}


def cargo(*arguments):
    return subprocess.run(["cargo", *arguments], check=True, capture_output=True, text=True).stdout


def linked(target, features):
    """Names and versions of what ends up in the program: not what builds and tests alone need."""
    tree = ["tree", "--locked", "--package=aeye", "--edges=normal", "--prefix=none", "--format={p}", f"--target={target}"]
    return {tuple(line.split()[:2]) for line in cargo(*tree, *features).splitlines()}


def licences(folder):
    """The licences in a library's folder, the outermost first."""
    found = [path.relative_to(folder) for path in folder.rglob("*") if path.is_file() and path.suffix not in CODE]
    found = [path for path in found if LICENCE.search(path.as_posix())]
    return [folder / path for path in sorted(found, key=lambda path: (len(path.parts), path))]


def main():
    target, features = sys.argv[1], sys.argv[2:]
    inside, texts = linked(target, features), {}
    metadata = cargo("metadata", "--format-version=1", "--locked", f"--filter-platform={target}")
    packages = json.loads(metadata)["packages"]
    packages = [each for each in packages if each["source"] and (each["name"], f"v{each['version']}") in inside]
    print("Libraries in this program, their licences and authors as they name them, and then the texts that they come with.\n")
    for package in sorted(packages, key=lambda package: (package["name"], package["version"])):
        name = f"{package['name']} {package['version']}"
        print("; ".join([f"{name}: {package['license'] or package['license_file']}", *package["authors"]]))
        for path in licences(pathlib.Path(package["manifest_path"]).parent):
            texts.setdefault(path.read_text(errors="replace").strip(), []).append(name)
    for text, names in texts.items():
        print(f"\n{'-' * 100}\n{', '.join(dict.fromkeys(names))}\n\n{text}")


if __name__ == "__main__":
    main()
