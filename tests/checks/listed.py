"""Every source, and every header of a library, is named in the CMakeLists.txt of its folder: a test
file that is not is never run, a header that is not is never compiled alone. The headers of
programs, tests and benchmarks are found by stipple_verify_headers of cmake/StippleTargets.cmake."""

import re

from tree import LIBRARIES, report


def check(tree):
    libraries = tree.of_modules(".h", modules=LIBRARIES)
    for name in tree.ending(".cpp", ".h", "_test.py"):
        folder, _, file = name.rpartition("/")
        if file.endswith(".h") and (name not in libraries or "-inl." in file):
            continue
        lists = f"{folder}/CMakeLists.txt"
        while lists not in tree.files and "/" in folder:
            folder = folder.rpartition("/")[0]
            lists = f"{folder}/CMakeLists.txt"
        relative = name[len(folder) + 1:]
        if lists not in tree.files or not is_named(relative, lists, tree):
            yield f"{name}: not named in {lists}"


def is_named(relative, lists, tree):
    if relative.endswith(".py"):  # x_test, or x where one rule adds all tests
        stem = relative.removesuffix(".py")
        return re.search(rf"\b{stem}\b|\b{stem.removesuffix('_test')}\b", tree.text(lists))
    file = relative.rpartition("/")[2]
    pattern = re.compile(rf"(?<![\w/]){re.escape(relative)}\b|/{re.escape(file)}\b")
    return any(pattern.search(tree.text(name)) for name in tree.ending("CMakeLists.txt", ".cmake"))


if __name__ == "__main__":
    report(check)
