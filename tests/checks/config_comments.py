"""Every key of config/**/*.toml is explained, on its own line or on the one above."""

import re
import tomllib

from tree import report

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
        for number, line in tree.lines(name):
            key = KEY.match(line)
            if key and "#" not in STRING.sub("", line) and not above.startswith("#"):
                yield f"{name}:{number}: {key[1]} has no comment (meaning, unit, default)"
            above = line.lstrip()


if __name__ == "__main__":
    report(check)
