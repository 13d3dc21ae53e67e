"""The reference of the Python module, on one page, from the stub that the build writes and from errors.py."""
import ast
import html
import pathlib
import re

KINDS = ("Args", "Raises", "Returns")


def inline(text):
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(" ".join(text.split()), quote=False))


def described(doc):
    """HTML of a docstring."""
    made = ""
    for block in re.split(r"\n\s*\n", doc):
        lines = block.splitlines()
        title = lines[0].strip().rstrip(":") if lines else ""
        if title in KINDS and lines[0].strip().endswith(":"):
            entries = []
            for line in lines[1:]:
                if re.match(r" {0,4}\S", line) and re.match(r"\s*\w+: ", line):
                    entries.append(line.strip())
                elif entries:
                    entries[-1] += " " + line.strip()
                else:
                    entries.append(line.strip())
            made += f'<p class="part">{"Arguments" if title == "Args" else title}</p><dl>'
            for entry in entries:
                name, _, told = entry.partition(": ")
                made += f"<dt><code>{html.escape(name)}</code></dt><dd>{inline(told)}</dd>" if told else f"<dd>{inline(name)}</dd>"
            made += "</dl>"
        elif block.strip():
            code = all(line.startswith("    ") for line in lines)
            made += f"<pre><code>{html.escape(block)}</code></pre>" if code else f"<p>{inline(block)}</p>"
    return made


def signature(node, width=92):
    """As the stub has it, an argument per line where it is long."""
    arguments = node.args
    parts = []
    positional = [a for a in arguments.args if a.arg != "self"]
    defaults = [None] * (len(positional) - len(arguments.defaults)) + list(arguments.defaults)

    def shown(argument, default):
        kind = f": {ast.unparse(argument.annotation)}" if argument.annotation else ""
        return argument.arg + kind + (f" = {ast.unparse(default)}" if default is not None else "")

    parts += [shown(*each) for each in zip(positional, defaults)]
    if arguments.vararg:
        parts.append("*" + shown(arguments.vararg, None))
    elif arguments.kwonlyargs:
        parts.append("*")
    parts += [shown(*each) for each in zip(arguments.kwonlyargs, arguments.kw_defaults)]
    tail = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    one = f"def {node.name}({', '.join(parts)}){tail}"
    text = one if len(one) <= width else f"def {node.name}(\n    " + ",\n    ".join(parts) + f",\n){tail}"
    return text.replace("str | PathLike[str]", "Path")


def is_property(node):
    return any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)


def fenced(code):
    return f"\n```python\n{code}\n```\n"


def class_text(node, names):
    text = f"\n## {node.name}\n\n"
    bases = [ast.unparse(base) for base in node.bases if ast.unparse(base) in names or ast.unparse(base).endswith(("Error", "Interrupt"))]
    if bases:
        text += f"Is a {' and a '.join(f'`{base}`' for base in bases)}.\n\n"
    text += described(ast.get_docstring(node) or "") + "\n"
    rows, methods = "", {}
    for member in node.body:
        if not isinstance(member, ast.FunctionDef) or member.name.startswith("_") and member.name not in ("__iter__", "__len__", "__getitem__"):
            continue
        if is_property(member):
            rows += (f"<dt><code>{member.name}</code> <span class=\"type\">{html.escape(ast.unparse(member.returns))}</span></dt>"
                     f"<dd>{described(ast.get_docstring(member) or '')}</dd>")
        else:
            methods.setdefault(member.name, []).append(member)
    if rows:
        text += f'\n<dl class="members">{rows}</dl>\n'
    for name, overloads in methods.items():
        text += f"\n### {node.name}.{name}\n" + fenced("\n".join(signature(each) for each in overloads))
        text += described(ast.get_docstring(overloads[0]) or "") + "\n"
    return text


def write(root, module_folder, out):
    """Writes python.md into the folder `out`. Returns whether the stub was there, which needs the built module."""
    package = root / "python" / "rigcal"
    stub = module_folder / "rigcal" / "_rigcal.pyi"
    public = next(ast.literal_eval(node.value) for node in ast.parse((package / "__init__.py").read_text(encoding="utf-8")).body
                  if isinstance(node, ast.Assign) and node.targets[0].id == "__all__")
    nodes = {}
    for source in filter(pathlib.Path.exists, (stub, package / "errors.py")):
        for node in ast.parse(source.read_text(encoding="utf-8")).body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and node.name in public:
                nodes.setdefault(node.name, node)
    functions = [node for node in nodes.values() if isinstance(node, ast.FunctionDef)]
    classes = [node for node in nodes.values() if isinstance(node, ast.ClassDef)]
    first = ("Campaign", "Fit", "Result", "Record", "Simulation")
    classes.sort(key=lambda node: (first.index(node.name) if node.name in first else len(first), "Error" in node.name, node.name))
    text = ["# Classes and functions of `rigcal`\n\nMade from the module's stub; `help(rigcal.Fit)` shows the same. All is in SI. "
            "[The module](../python.md) tells how these work together.\n\n## Functions\n"]
    for node in functions:
        text.append(f"\n### {node.name}\n" + fenced(signature(node)) + described(ast.get_docstring(node) or "") + "\n")
    text += [class_text(node, set(nodes)) for node in classes]
    (out / "python.md").write_text("".join(text), encoding="utf-8")
    return stub.exists()
