"""Files of at most 400 lines, functions of at most 60 (docs/style.md). clang-tidy measures the
functions of the modules exactly; here the layout of clang-format is enough to see those of tests,
benchmarks and Python as well."""

import ast
import re

from tree import report

MOST_FILE_LINES = 400
MOST_FUNCTION_LINES = 60
NO_FUNCTION = re.compile(
    r'(namespace|class|struct|enum|union|if|for|while|switch|do|else|try)\b|extern "C" {|.*= {$')


def check(tree):
    for name in tree.ending(".h", ".cpp", ".py", ".cmake", "CMakeLists.txt"):
        lines = tree.text(name).splitlines()
        if len(lines) > MOST_FILE_LINES:
            yield f"{name}: {len(lines)} lines; at most {MOST_FILE_LINES}"
        functions = python_functions if name.endswith(".py") else cpp_functions
        if name.endswith((".py", ".h", ".cpp")):
            for first, count in functions(lines):
                if count > MOST_FUNCTION_LINES:
                    limit = f"at most {MOST_FUNCTION_LINES}"
                    yield f"{name}:{first}: function of {count} lines; {limit}"


def python_functions(lines):
    """(first line, number of lines) of each function."""
    for node in ast.walk(ast.parse("\n".join(lines))):
        if isinstance(node, ast.FunctionDef):
            yield node.lineno, node.end_lineno - node.lineno + 1


def cpp_functions(lines):
    """The same for C++: from a line that ends in `{` and begins no type, namespace or statement to
    the first `}` at its indentation. A head of several lines counts from its last."""
    number = 0
    while number < len(lines):
        line = lines[number]
        end = closing_line(lines, number) if line.endswith("{") else None
        if end is None or NO_FUNCTION.match(line.lstrip()) or "(" not in head(lines, number):
            number += 1
            continue
        yield number + 1, end - number + 1
        number = end + 1


def head(lines, number):
    """The statement that ends in line `number`."""
    first = number
    while first > 0 and lines[first - 1] and lines[first - 1][-1] not in "{};:/":
        first -= 1
    return " ".join(lines[first:number + 1])


def closing_line(lines, number):
    """Continuation lines of a head are indented deeper than its brace, hence `<=`."""
    indent = len(lines[number]) - len(lines[number].lstrip())
    for later in range(number + 1, len(lines)):
        text = lines[later].lstrip()
        if text.startswith("}") and len(lines[later]) - len(text) <= indent:
            return later
    return None


if __name__ == "__main__":
    report(check)
