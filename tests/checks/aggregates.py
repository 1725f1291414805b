"""No list of initialisers has a braced member without its type before one that calls a function: if that call
throws, g++ 12 destroys the member twice. `.choice = Choice{...}` is right, `.choice = {...}` is not."""

import re

from tree import report

NOT_CODE = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|//[^\n]*|/\*.*?\*/', re.S)
BRACED = re.compile(r"(?=[{,]\s*(\.\w+\s*=?\s*{(?!\s*})|{(?=\s*\.\w)))")  # .name = {x} or {.name = x}


def check(tree):
    for name in tree.ending(".h", ".cpp"):
        code = NOT_CODE.sub(lambda text: "\n" * text[0].count("\n"), tree.text(name))
        for braced in BRACED.finditer(code):
            if "(" in after(code, braced.end(1)):
                line = code.count("\n", 0, braced.end(1)) + 1
                yield f"{name}:{line}: a later initialiser may throw; name the type before this brace (g++ 12)"


def after(code, begin):
    """What follows a braced member, to the end of the braced list that it belongs to; "" of an argument."""
    depth = 1
    end = None
    for at in range(begin, len(code)):
        depth += (code[at] in "{([") - (code[at] in "})]")
        if depth == 0 and end is None:
            end = at
        elif depth < 0 or (depth == 0 and code[at] == ";"):
            return code[end:at] if code[at] == "}" else ""
    return ""


if __name__ == "__main__":
    report(check)
