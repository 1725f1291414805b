"""Messages that docs/troubleshooting.md quotes, `as this ...`, are messages of the program: each stands in a
source, with any text in place of "..." and of an option, which is a Parameter there. Code in the first column
of its tables is a message if it has a blank."""

import re

from tree import report

PAGE = "docs/troubleshooting.md"
QUOTED = re.compile(r"`([^`]* [^`]*)`")
OPTION = re.compile(r"--[a-z][\w-]*(?: [\w.]+)?")


def check(tree):
    if PAGE not in tree.files:
        return
    said = "\n".join(texts_of(tree.text(name)) for name in tree.of_modules(".cpp"))
    for number, line in tree.lines(PAGE):
        if not line.startswith("| "):
            continue
        for message in QUOTED.findall(line.split(" | ")[0]):
            parts = map(re.escape, OPTION.sub("...", message.strip()).split("..."))
            if not re.search(r"[^\n]*?".join(parts), said):
                yield f'{PAGE}:{number}: no source says "{message}"; quote the present message'


def texts_of(source):
    """The source with its literals as they are printed, a line for a statement: parts joined, quotes without
    backslash."""
    quote = "\0"
    source = re.sub(r"(?<![;{}])\n\s*", " ", source)
    return re.sub(r'"\s*"', "", source.replace('\\"', quote)).replace(quote, '"')


if __name__ == "__main__":
    report(check)
