"""Every key of config/**/*.toml is explained, on its own line or on the one above; of a list of tables, the first
one of its name."""

import re
import tomllib

from tree import report

LIST = re.compile(r"\[\[([\w.-]+)\]\]")
KEY = re.compile(r"\s*([\w.-]+)\s*=")
STRING = re.compile(r'"(?:\\.|[^"\\])*"|\'[^\']*\'')


def check(tree):
    for name in tree.ending(".toml"):
        if not name.startswith("config/"):
            continue
        try:
            tomllib.loads(tree.text(name))
        except tomllib.TOMLDecodeError as error:
            yield f"{name}: {error}"
        above = ""
        of_list = None  # the list of tables that the line belongs to
        explained = set()  # keys of lists of tables
        for number, line in tree.lines(name):
            if line.startswith("["):
                header = LIST.match(line)
                of_list = header and header[1]
            key = KEY.match(line)
            if key and (of_list is None or (of_list, key[1]) not in explained):
                if "#" not in STRING.sub("", line) and not above.startswith("#"):
                    yield f"{name}:{number}: {key[1]} has no comment (meaning, unit, default)"
                explained.add((of_list, key[1]))
            above = line.lstrip()


if __name__ == "__main__":
    report(check)
