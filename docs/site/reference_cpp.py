"""The reference of the C++ libraries: what Doxygen reads from the headers that are installed, as a page per library."""
import html
import re
import subprocess
import tempfile
import xml.etree.ElementTree as ET
from pathlib import Path

LIBRARIES = {
    "common": "Quantities with units, files, threads, errors.",
    "model": "The rig as a system of differential equations, and its solver with sensitivities.",
    "metrics": "Scores, residual tests and statistics of series.",
    "datasets": "Campaign files, recordings, averaging, synthetic records.",
    "calib": "Fits, their uncertainty, scores and the verdict.",
    "diagnosis": "Leaks of records, states of a machine, parity residuals and alarms.",
    "report": "Result files, terminal, pages, figures.",
}
DOXYFILE = """
INPUT = {input}
FILE_PATTERNS = *.hpp
RECURSIVE = YES
EXCLUDE_PATTERNS = */model/wasm/*
OUTPUT_DIRECTORY = {output}
STRIP_FROM_PATH = {root}
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
HAVE_DOT = NO
QUIET = YES
WARN_IF_UNDOCUMENTED = NO
WARN_IF_INCOMPLETE_DOC = NO
ALIASES = "source=\\par Source^^" "deviation=\\par Deviation^^"
"""
SECTIONS = {"throws": "Throws", "exception": "Throws", "return": "Returns", "note": "Note", "see": "See", "warning": "Warning",
            "pre": "Before the call", "post": "After the call"}


def public_headers(root):
    """rigcal.hpp and the headers that it includes, directly or by way of others: those that are installed."""
    waiting, found = ["rigcal.hpp"], set()
    while waiting:
        header = waiting.pop()
        if header not in found:
            found.add(header)
            waiting += re.findall(r'^#include "([^"]+)"', (root / header).read_text(encoding="utf-8"), re.MULTILINE)
    return found


class Stale(Exception):
    """A comment tells of an argument that is not there."""


class Missing(Exception):
    """Doxygen is not installed."""


def text_of(node):
    return "" if node is None else re.sub(r"\s+", " ", "".join(node.itertext())).strip()


def prose(node):
    """HTML of a description: the text of its paragraphs, code and lists."""
    if node is None:
        return ""
    inside = html.escape(node.text or "", quote=False)
    for child in node:
        if child.tag == "title":
            continue
        inside += prose(child) + html.escape(child.tail or "", quote=False)
    tag = node.tag
    if tag == "para":
        blocks = ("<ul>", "<dl>", "<p")
        if not any(each in inside for each in blocks):
            return f"<p>{inside.strip()}</p>" if inside.strip() else ""
        # Text before the first list is a paragraph of its own.
        first = min(inside.find(each) for each in blocks if each in inside)
        before = inside[:first].strip()
        return (f"<p>{before}</p>" if before else "") + inside[first:].strip()
    if tag in ("computeroutput", "verbatim"):
        return f"<code>{inside}</code>"
    if tag in ("itemizedlist", "orderedlist"):
        return f"<ul>{inside}</ul>"
    if tag == "listitem":
        return f"<li>{inside}</li>"
    if tag in ("bold", "emphasis"):
        return f"<em>{inside}</em>"
    if tag == "parameterlist":
        title = {"param": "Arguments", "templateparam": "Of the template"}.get(node.get("kind"), "Throws")
        rows = "".join(f"<dt><code>{', '.join(html.escape(text_of(n)) for n in item.iter('parametername'))}</code></dt>"
                       f"<dd>{prose(item.find('parameterdescription'))}</dd>" for item in node.findall("parameteritem"))
        return f"<p class=\"part\">{title}</p><dl>{rows}</dl>"
    if tag == "simplesect":
        title = text_of(node.find("title")) or SECTIONS.get(node.get("kind"), node.get("kind", "").capitalize())
        return f"<p class=\"part\">{title}</p>{inside}"
    return inside


def described(node):
    parts = (node.find(each) for each in ("briefdescription", "detaileddescription", "inbodydescription"))
    return "".join(prose(part).strip() for part in parts)


def tidy(code):
    return re.sub(r"\s+", " ", code).replace("< ", "<").replace(" >", ">").replace(" &", "&").replace(" *", "*").strip()


def wrapped(head, arguments, tail, width=92):
    """A declaration as clang-format would break it."""
    one = f"{head}({', '.join(arguments)}){tail}"
    if len(one) <= width or not arguments:
        return one
    indent = " " * (len(head) + 1 if len(head) < 50 else 4)
    lines, line = [], ""
    for k, argument in enumerate(arguments):
        piece = argument + (", " if k + 1 < len(arguments) else "")
        if line and len(indent) + len(line) + len(piece.rstrip()) > width:
            lines.append(line.rstrip())
            line = ""
        line += piece
    return f"{head}(" + f"\n{indent}".join([*lines, line]) + f"){tail}"


def template_of(node):
    found = node.find("templateparamlist")
    if found is None:
        return ""
    parts = [tidy(f"{text_of(p.find('type'))} {text_of(p.find('declname'))}") for p in found.findall("param")]
    return f"template <{', '.join(parts)}>\n"


def function(node):
    arguments = []
    for p in node.findall("param"):
        default = text_of(p.find("defval"))
        arguments.append(tidy(f"{text_of(p.find('type'))} {text_of(p.find('declname'))}{text_of(p.find('array'))}") +
                         (f" = {tidy(default)}" if default else ""))
    kind = "static " if node.get("static") == "yes" else ""
    head = tidy(f"{kind}{text_of(node.find('type'))} {text_of(node.find('name'))}")
    args = text_of(node.find("argsstring"))
    tail = " const" if node.get("const") == "yes" else ""
    tail += " noexcept" if node.get("noexcept") == "yes" else ""
    tail += " = 0" if args.endswith("=0") else " = default" if args.endswith("=default") else " = delete" if args.endswith("=delete") else ""
    return template_of(node) + wrapped(head, arguments, tail) + ";"


def variable(node):
    start = tidy(text_of(node.find("initializer")))
    if len(start) > 60:  # a table, whose rows are no part of the interface
        start = ""
    gap = "" if start in ("", "{}") else " "
    return tidy(f"{text_of(node.find('type'))} {text_of(node.find('name'))}{text_of(node.find('argsstring'))}{gap}{start}") + ";"


def enumeration(node):
    values = ", ".join(text_of(value.find("name")) for value in node.findall("enumvalue"))
    strong = "enum class" if node.get("strong") == "yes" else "enum"
    line = f"{strong} {text_of(node.find('name'))} {{ {values} }};"
    return line if len(line) <= 92 else line.replace("{ ", "{\n  ").replace(", ", ",\n  ").replace(" }", "\n}")


def alias(node):
    kind = tidy(text_of(node.find("type")))
    definition = text_of(node.find("definition"))
    return template_of(node) + (f"using {text_of(node.find('name'))} = {kind};" if definition.startswith("using") else tidy(definition) + ";")


DECLARED = {"function": function, "variable": variable, "enum": enumeration, "typedef": alias}


def fenced(code):
    return f"\n```cpp\n{code}\n```\n"


def values_of(node):
    """What the values of an enumeration mean, where that is told."""
    rows = "".join(f"<dt><code>{text_of(value.find('name'))}</code></dt><dd>{told}</dd>"
                   for value in node.findall("enumvalue") if (told := described(value)))
    return f"<dl>{rows}</dl>\n" if rows else ""


def members_of(node):
    for section in node.findall("sectiondef"):
        if section.get("kind", "").startswith("private") or section.get("kind") == "friend":
            continue
        for member in section.findall("memberdef"):
            if member.get("prot") == "public" and member.get("kind") in DECLARED:
                yield member


def compound(node):
    """A class or struct: one block with its members, then what is told about them."""
    name = text_of(node.find("compoundname")).split("::")
    bases = [f"public {tidy(text_of(base))}" for base in node.findall("basecompoundref") if base.get("prot") == "public"]
    members = list(members_of(node))
    short = name[-1]
    lines = [f"{template_of(node)}{node.get('kind')} {short}{' : ' + ', '.join(bases) if bases else ''} {{"]
    public = "" if node.get("kind") == "struct" else " public:\n"
    body = "\n".join("  " + DECLARED[m.get("kind")](m).replace("\n", "\n  ") for m in members)
    lines.append(public + body)
    lines.append("};")
    rows = ""
    for member in members:
        told = described(member) + values_of(member)
        if told:
            rows += f"<dt><code>{html.escape(text_of(member.find('name')))}</code></dt><dd>{told}</dd>"
    return fenced("\n".join(line for line in lines if line)) + f"\n{described(node)}\n" + (f"\n<dl class=\"members\">{rows}</dl>\n" if rows else "")


def hidden(name):
    return any(part in ("detail", "internal") or part.startswith("@") for part in name.split("::"))


def headers_of(folder):
    """By header: the declarations in it, in the order of their lines, as (line, Markdown)."""
    found = {}

    def put(where, markdown):
        found.setdefault(where.get("file"), []).append((int(where.get("line", 0)), markdown))

    inner = set()
    compounds = []
    for path in sorted(folder.glob("*.xml")):
        if path.name == "index.xml":
            continue
        for node in ET.parse(path).getroot().findall("compounddef"):
            name = text_of(node.find("compoundname"))
            if node.get("kind") in ("class", "struct"):
                inner.update(each.get("refid") for each in node.findall("innerclass"))
                if not hidden(name) and "<" not in name.rpartition("::")[2]:
                    compounds.append(node)
            elif node.get("kind") == "namespace" and not hidden(name):
                for member in node.iter("memberdef"):
                    if member.get("kind") in DECLARED:
                        put(member.find("location"), fenced(DECLARED[member.get("kind")](member)) + f"\n{described(member)}\n{values_of(member)}")
    for node in compounds:
        if node.get("prot", "public") == "public":
            put(node.find("location"), compound(node))
    return {header: [markdown for _, markdown in sorted(set(parts))] for header, parts in found.items()}


def page(library, about, headers):
    """Rooms (folders) as sections, headers beneath them."""
    text = [f"# {library}\n\n{about} Link with `rigcal::{library}` ([installing](../install.md#libraries)). All is in namespace "
            f"`rigcal`{'' if library == 'common' else f', most in `rigcal::{library}`'}.\n"]
    of_room = {}
    for header, parts in headers.items():
        if header.split("/")[0] == library:
            of_room.setdefault(header.rpartition("/")[0], {})[header] = parts
    for room in sorted(of_room):
        text.append(f"\n## {room}\n")
        for header in sorted(of_room[room]):
            text.append(f"\n### {header.rpartition('/')[2]}\n\n<p class=\"include\"><code>rigcal/{header}</code></p>\n")
            text += of_room[room][header]
    return "".join(text)


def stale_comments(told, root):
    """What Doxygen tells of arguments that are not there; in a comment of the code's own (`/*x*/`) they are."""
    for line in told.splitlines():
        found = re.match(r"(?P<header>.*?):(?P<line>\d+): warning: argument '(?P<name>\w+)' .*(?:is not found|has multiple)", line)
        if found and f"/*{found['name']}*/" not in Path(found["header"]).read_text(encoding="utf-8"):
            yield f"{Path(found['header']).relative_to(root)}:{found['line']}: @param {found['name']}"


def write(root, out):
    """Writes cpp.md and cpp-LIBRARY.md into the folder `out`."""
    with tempfile.TemporaryDirectory() as folder:
        settings = DOXYFILE.format(input=" ".join(str(root / name) for name in LIBRARIES), output=folder, root=root)
        try:
            done = subprocess.run(["doxygen", "-"], input=settings, text=True, check=True, capture_output=True)
        except FileNotFoundError:
            raise Missing("doxygen is missing: scripts/setup --dev") from None
        if stale := list(stale_comments(done.stderr, root)):
            raise Stale("no such argument, or it is told of twice: " + ", ".join(stale))
        public = public_headers(root)
        headers = {name: parts for header, parts in headers_of(Path(folder) / "xml").items()
                   if (name := re.sub(f"^{re.escape(str(root))}/", "", header)) in public}
    rows = ""
    for name, about in LIBRARIES.items():
        text = page(name, about, headers)
        (out / f"cpp-{name}.md").write_text(text, encoding="utf-8")
        count = sum(header.startswith(name + "/") for header in headers)
        rows += f"| [`rigcal::{name}`](cpp-{name}.md) | {about} | {count} |\n"
    (out / "cpp.md").write_text(
        "# The C++ libraries\n\nMade from the comments of the headers. [Installing](../install.md#libraries) tells how a program finds "
        "and links them, [architecture](../architecture.md) how they depend on each other. A program that fits a campaign is shown "
        "there, too.\n\n| library | contents | headers |\n| --- | --- | ---: |\n" + rows, encoding="utf-8")
