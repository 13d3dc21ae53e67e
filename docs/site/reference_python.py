"""The reference of the Python module: signatures from its stub, the rest from its docstrings, on one page."""
import ast
import html
import json
import os
import re
import subprocess

KINDS = ("Args", "Raises", "Returns")
# Runs in the Python that the module is built for; prints the docstring of everything that has one.
COLLECT = """
import inspect, json, rigcal
found = {"": rigcal.__doc__}
for name in rigcal.__all__:
    what = getattr(rigcal, name)
    if inspect.isclass(what):
        found[name] = what.__dict__.get("__doc__") or ""
        for member, value in vars(what).items():
            if not member.startswith("_") or member in ("__init__", "__iter__", "__len__", "__getitem__"):
                found[f"{name}.{member}"] = getattr(value, "__doc__", None) or ""
    elif callable(what):
        found[name] = what.__doc__ or ""
print(json.dumps(found))
"""


def docstrings(module_folder):
    """By qualified name; empty where the module is not built."""
    if not (module_folder / "rigcal").is_dir():
        return {}
    done = subprocess.run(["/usr/bin/python3", "-c", COLLECT], env={**os.environ, "PYTHONPATH": str(module_folder)}, capture_output=True,
                          text=True, check=False)
    return json.loads(done.stdout) if done.returncode == 0 else {}


def without_signature(doc):
    """pybind11 puts the signature first, and numbers overloads."""
    lines = doc.strip("\n").splitlines()
    if lines and re.match(r"\w+\(.*\) -> ", lines[0]):
        lines = lines[1:]
    text = "\n".join(lines).strip("\n")
    if text.startswith("Overloaded function."):
        parts = re.split(r"\n\d+\. \w+\(.*\) -> .*\n", text)[1:]
        text = max(parts, key=len).strip("\n")
    return text


def inline(text):
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(" ".join(text.split()), quote=False))


def described(doc):
    """HTML of a docstring."""
    made = ""
    for block in re.split(r"\n\s*\n", without_signature(doc)):
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
    return text.replace("Path_", "Path")


def is_property(node):
    return any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)


def fenced(code):
    return f"\n```python\n{code}\n```\n"


def class_text(node, docs, names):
    text = f"\n## {node.name}\n\n"
    bases = [ast.unparse(base) for base in node.bases if ast.unparse(base) in names or ast.unparse(base).endswith(("Error", "Interrupt"))]
    if bases:
        text += f"Is a {' and a '.join(f'`{base}`' for base in bases)}.\n\n"
    text += described(docs.get(node.name, ast.get_docstring(node) or "")) + "\n"
    rows, methods = "", {}
    for member in node.body:
        if isinstance(member, ast.AnnAssign):
            rows += (f"<dt><code>{member.target.id}</code> <span class=\"type\">{html.escape(ast.unparse(member.annotation))}</span></dt>"
                     f"<dd>{described(docs.get(f'{node.name}.{member.target.id}', ''))}</dd>")
        if not isinstance(member, ast.FunctionDef) or member.name.startswith("_") and member.name not in ("__iter__", "__len__", "__getitem__"):
            continue
        if is_property(member):
            doc = docs.get(f"{node.name}.{member.name}", ast.get_docstring(member) or "")
            rows += (f"<dt><code>{member.name}</code> <span class=\"type\">{html.escape(ast.unparse(member.returns))}</span></dt>"
                     f"<dd>{described(doc)}</dd>")
        else:
            methods.setdefault(member.name, []).append(member)
    if rows:
        text += f'\n<dl class="members">{rows}</dl>\n'
    for name, overloads in methods.items():
        text += f"\n### {node.name}.{name}\n" + fenced("\n".join(signature(each) for each in overloads))
        text += described(docs.get(f"{node.name}.{name}", ast.get_docstring(overloads[0]) or "")) + "\n"
    return text


def write(root, module_folder, out):
    """Writes python.md into the folder `out`. Returns whether the docstrings of the module were there."""
    docs = docstrings(module_folder)
    package = root / "python" / "rigcal"
    public = next(ast.literal_eval(node.value) for node in ast.parse((package / "__init__.py").read_text(encoding="utf-8")).body
                  if isinstance(node, ast.Assign) and node.targets[0].id == "__all__")
    nodes = {}
    for source in ("_rigcal.pyi", "errors.py"):
        for node in ast.parse((package / source).read_text(encoding="utf-8")).body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and node.name in public:
                nodes.setdefault(node.name, node)
    functions = [node for node in nodes.values() if isinstance(node, ast.FunctionDef)]
    classes = [node for node in nodes.values() if isinstance(node, ast.ClassDef)]
    first = ("Campaign", "Fit", "Result", "Record", "Simulation")
    classes.sort(key=lambda node: (first.index(node.name) if node.name in first else len(first), "Error" in node.name, node.name))
    text = ["# Classes and functions of `rigcal`\n\nMade from the module's stub and docstrings; `help(rigcal.Fit)` shows the same. All is in SI. "
            "[The module](../python.md) tells how these work together.\n\n## Functions\n"]
    for node in functions:
        text.append(f"\n### {node.name}\n" + fenced(signature(node)) + described(docs.get(node.name, "")) + "\n")
    text += [class_text(node, docs, set(nodes)) for node in classes]
    (out / "python.md").write_text("".join(text), encoding="utf-8")
    missing = set(public) - set(nodes) - {"__version__", "__revision__"}
    if missing:
        raise ValueError(f"python/rigcal/_rigcal.pyi lacks {sorted(missing)}")
    return bool(docs)
