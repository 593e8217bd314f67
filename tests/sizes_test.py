# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes beyond which code is divided: sources of a folder, lines of a source and of a function, parameters of a function.

  python3 tests/sizes_test.py <root of the project>

prints what is too large, and fails if anything is. A function is counted from the first line of its signature to its closing
brace; what stands in a class as well as what stands in a namespace. The kernels of vector instructions take more parameters, as
they pass what lies in registers.
"""
import os
import re
import sys

FOLDER_SOURCES = 30
SOURCE_LINES = 450
FUNCTION_LINES = 80
PARAMETERS = 7
VECTOR_KERNELS = re.compile(r"_kernels(_[a-z0-9]+)?\.(h|cc)$")
LITERALS = re.compile(
    r'R"(?P<tag>[^(]{0,16})\(.*?\)(?P=tag)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|//[^\n]*|/\*.*?\*/|^[ \t]*#(?:\\\n|[^\n])*',
    re.DOTALL | re.MULTILINE)
SCOPE = re.compile(r"\b(namespace|class|struct|union|enum|extern)\b")


def without_literals(text):
  """Comments, strings, characters and directives become blanks; line breaks stay, digit separators go."""
  text = re.sub(r"(?<=[0-9a-fA-F])'(?=[0-9a-fA-F])", "", text)
  return LITERALS.sub(lambda found: re.sub(r"[^\n]", " ", found.group(0)), text)


def parameters_of(signature):
  """The number of parameters of a function, from what stands before its body."""
  start = signature.find("(")
  if signature[:start].rstrip().endswith("operator"):
    start = signature.find("(", start + 1)
  depth, angle, commas = 0, 0, 0
  for position in range(start, len(signature)):
    character = signature[position]
    depth += (character in "([{") - (character in ")]}")
    angle += (character == "<") - (character == ">" and signature[position - 1] != "-")
    commas += character == "," and depth == 1 and angle == 0
    if depth == 0:
      break
  return commas + 1 if signature[start + 1:position].strip() else 0


def kind_of(head):
  """What a brace of a namespace or class opens, by what stands before it, parentheses and braces emptied."""
  head = head.strip()
  ends_as_function = re.search(r"(\)|\}|\b(const|override|noexcept|final))$|->\s*[\w:<>&*, ]+$", head)
  if SCOPE.search(re.sub(r"<[^<>]*>|\(\)", " ", head)) and not ends_as_function:
    return "scope"
  # Members that a constructor initializes, default values, arrays.
  if "(" not in head or not ends_as_function:
    return "inner"
  if "operator" not in head and re.search(r"(^|[^=!<>])=[^=]", head):
    return "inner"  # a lambda that is a constant
  return "function"


def functions_of(text):
  """(line, lines, name, parameters) of every function with a body."""
  text = without_literals(text)
  found = []
  open_braces = []  # (kind, where the declaration begins, where the brace is)
  head, head_start, last, parentheses = "", 0, 0, 0
  for match in re.finditer(r"[(){};]|\b(?:public|private|protected)\s*:", text):
    token = match.group(0)
    in_scope = not open_braces or open_braces[-1][0] == "scope"
    if in_scope and parentheses == 0:
      head += text[last:match.start()]
    last = match.end()
    ended = False  # a declaration
    if token == "{":
      kind = kind_of(head) if in_scope and parentheses == 0 else "inner"
      open_braces.append((kind, head_start, match.start()))
      ended = kind == "scope"
      if in_scope and parentheses == 0:
        head += "{}"
    elif token == "}" and open_braces:
      kind, begin, brace = open_braces.pop()
      ended = kind != "inner"
      if kind == "function":
        signature = text[begin:brace]
        begin += len(signature) - len(signature.lstrip())
        name = re.sub(r"\s+", " ", signature.split("(")[0]).strip().split(" ")[-1]
        if name in ("TEST", "TEST_F", "TEST_P"):
          name = re.sub(r"\s+", " ", signature).strip()
        found.append((text.count("\n", 0, begin) + 1, text.count("\n", begin, match.start()) + 1, name,
                      parameters_of(signature)))
    elif in_scope and token in "()":
      head += token if parentheses == (0 if token == "(" else 1) else ""
      parentheses += 1 if token == "(" else -1
    elif in_scope and parentheses == 0:
      ended = True
    if ended:
      head, head_start = "", match.end()
  return found


def check_the_counter():
  """Raises AssertionError where functions are counted wrongly."""
  sample = """
namespace a {
struct S final : public B<int, 2> {
  explicit S(int x, std::map<int, double> y = {{1, 2.}}) : x_(x), y_{y} {}
  bool operator()(int a) const { return "){".empty(); }  // }
  S() : S([]() { const int a = 1; return a; }, {2}), y_{3} {
  }
  int x_ = 0;
  static constexpr char kList[2] = {'{', '\\''};
};
const auto kFunction = [](int a) { return a; };
template <typename T>
T Long(T a, const F<int(int, int)>& b,
       int c) {
  if (a) {
    return [&]() { return 1'000; }();
  }
}
}  // namespace a
TEST(A, B) {}
"""
  counted = functions_of(sample)
  expected = [(4, 1, "S", 2), (5, 1, "operator", 1), (6, 2, "S", 0), (12, 7, "Long", 3), (20, 1, "TEST(A, B)", 2)]
  assert counted == expected, f"counted {counted} instead of {expected}"


def too_large(root):
  """What exceeds the limits below `root`, one line each."""
  errors = []
  count = 0
  for top in ("cartographer_ext", "tests"):
    for folder, _, names in os.walk(os.path.join(root, top)):
      sources = sorted(name for name in names if name.endswith((".h", ".cc")))
      short = os.path.relpath(folder, root)
      count += len(sources)
      if len(sources) > FOLDER_SOURCES:
        errors.append(f"{short}: {len(sources)} sources, more than {FOLDER_SOURCES}")
      for name in sources:
        path = os.path.join(short, name)
        with open(os.path.join(root, path), encoding="utf-8") as source:
          text = source.read()
        lines = text.count("\n")
        if lines > SOURCE_LINES:
          errors.append(f"{path}: {lines} lines, more than {SOURCE_LINES}")
        for line, length, function, parameters in functions_of(text):
          if length > FUNCTION_LINES:
            errors.append(f"{path}:{line}: {function} has {length} lines, more than {FUNCTION_LINES}")
          if parameters > PARAMETERS and not VECTOR_KERNELS.search(name):
            errors.append(f"{path}:{line}: {function} has {parameters} parameters, more than {PARAMETERS}")
  if count < 100:
    errors.append(f"only {count} sources below {root}")
  return errors


def main():
  check_the_counter()
  errors = too_large(sys.argv[1])
  print("\n".join(errors) if errors else "no folder, source or function is too large")
  return 1 if errors else 0


if __name__ == "__main__":
  sys.exit(main())
