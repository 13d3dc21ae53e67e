"""Prepares the sources of the site: the documents, with the drawings in them, the references, the changelog, the live rig and
the gallery."""
import html
import json
import re
import shutil

import reference_cpp
import reference_python

LIVE_PAGE = "paper-rig.html"
DRAWING = re.compile(r"^!\[(?P<alt>[^\]]*)\]\((?P<path>pictures/[\w-]+\.svg)\)$", re.M)
LIVE = re.compile(r"<!-- live -->\n(?P<with>.*?)<!-- without -->\n(?P<without>.*?)<!-- end of live -->\n", re.DOTALL)
COMMANDS = ("rigcal ", "scripts/", "cmake ", "mpirun ", "python3 ", "source <(")
INDENTED = re.compile(r"(?<=\n\n)(?P<lines>(?:    [^\n]*\n)+)(?=\n|$)")
CONSOLE = re.compile(r"^```console\n.*?^```$", re.DOTALL | re.M)


def inline_drawing(docs, match):
    """The drawing as part of the page, so that it has the colours of the page; Markdown would end it at a blank line."""
    svg = (docs / match["path"]).read_text(encoding="utf-8")
    return '<figure class="drawing">' + re.sub(r"\n\s*\n", "\n", svg).strip() + "</figure>"


def coloured(match):
    """A block of commands, indented in the document, with a language."""
    lines = [line[4:] for line in match["lines"].splitlines()]
    if not lines[0].startswith(COMMANDS):
        return match[0]
    return "```sh\n" + "\n".join(lines) + "\n```\n"


def console(match):
    """Output that begins with # is no prompt: an invisible word joiner tells the lexer."""
    return re.sub(r"^#", "\u2060#", match[0], flags=re.M)


def card(each):
    link, picture = each["page"], each.get("picture")
    shown = (f'<img src="{picture}" alt="" loading="lazy" width="600" height="450">' if picture
             else '<span class="no-picture" aria-hidden="true"></span>')
    verdict = f' <span class="verdict {each["verdict"].lower()}">{each["verdict"]}</span>' if each.get("verdict") else ""
    about = f' <a class="about" href="{each["document"]}">About this rig</a>' if each.get("document") else ""
    return (f'<li><a class="shot" href="{link}">{shown}<strong>{html.escape(each["title"])}</strong>{verdict}</a>'
            f'<span class="told">{html.escape(each["told"])}{about}</span></li>')


def gallery_of(folder):
    """The entries of build/gallery; empty where it was not made."""
    index = folder / "gallery.json"
    return json.loads(index.read_text(encoding="utf-8")) if index.is_file() else []


def put_gallery(gallery, folder, out):
    """Copies reports and pictures; returns the lists of cards that stand for `<!-- gallery -->` and `<!-- gallery: N -->`."""
    entries = []
    for each in gallery:
        (out / "gallery").mkdir(exist_ok=True)
        shutil.copy(folder / each["name"] / each["file"], out / "gallery" / f"{each['name']}.html")
        entry = {**each, "page": f"gallery/{each['name']}.html"}
        if (folder / f"{each['name']}.png").is_file():
            shutil.copy(folder / f"{each['name']}.png", out / "gallery" / f"{each['name']}.png")
            entry["picture"] = f"gallery/{each['name']}.png"
        if each.get("document"):
            entry["document"] = each["document"].replace(".md", ".html")
        entries.append(entry)
    return entries


def cards(entries):
    return '<ul class="cards">' + "".join(map(card, entries)) + "</ul>"


def with_report(text, entries, name):
    """A document of a rig leads to its reports."""
    links = [f'<a class="md-button" href="{each["page"]}">{html.escape(each["button"])}</a>' for each in entries if each.get("document") == name]
    if not links:
        return text
    title, _, rest = text.partition("\n")
    return f"{title}\n\n<p class=\"reports\">{' '.join(links)}</p>\n{rest}"


def decisions(folder):
    """A page that lists them; they are in no menu."""
    rows = "".join(f"- [{path.read_text(encoding='utf-8').partition(chr(10))[0].lstrip('# ')}]({path.name})\n"
                   for path in sorted(folder.glob("[0-9]*.md")))
    return "# Decisions\n\nWhy things are as they are, for those who change them. Each tells the question, the choice, and what it costs.\n\n" + rows


def prepare(root, out, *, live, gallery_folder, module_folder, say):
    """Fills the folder `out`, which is made anew.

    :param live: path of the live page of the source paper's rig, or None
    :param gallery_folder: what scripts/gallery made
    :param module_folder: where the Python module is built
    :param say: is told what is left out
    """
    docs = root / "docs"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    if live:
        shutil.copy(live, out / LIVE_PAGE)
    gallery = put_gallery(gallery_of(gallery_folder), gallery_folder, out)
    if not gallery:
        say("the gallery is empty: scripts/gallery makes it")
    for folder in ("extending", "notebook", "pictures", "schema", "site", "slurm", "tutorial"):
        shutil.copytree(docs / folder, out / folder, ignore=shutil.ignore_patterns("*.py", "__pycache__", "overrides"))
    texts = {path.relative_to(docs): path.read_text(encoding="utf-8") for path in [*docs.glob("*.md"), *docs.glob("decisions/*.md")]}
    texts["decisions/index.md"] = decisions(docs / "decisions")
    changelog = (root / "CHANGELOG.md").read_text(encoding="utf-8")
    texts["changelog.md"] = changelog.replace("](docs/", "](")
    for name, text in texts.items():
        text = LIVE.sub(lambda match: match["with" if live else "without"], text)
        text = DRAWING.sub(lambda match: inline_drawing(docs, match), text)
        text = INDENTED.sub(coloured, text)
        text = CONSOLE.sub(console, text)
        text = re.sub(r"<!-- gallery(?:: (\d+))? -->", lambda match: cards(gallery[:int(match[1] or len(gallery))]) if gallery else
                      "*The gallery is not part of this build of the site: `scripts/gallery` makes it.*", text)
        if str(name).startswith("decisions/0"):
            text = re.sub(r"\n", "\n\n[All decisions](index.md)\n", text, count=1)
        text = with_report(text, gallery, str(name).replace(".md", ".html"))
        (out / name).parent.mkdir(exist_ok=True)
        (out / name).write_text(text, encoding="utf-8")
    (out / "reference").mkdir()
    reference_cpp.write(root, out / "reference")
    if not reference_python.write(root, module_folder, out / "reference"):
        say("the reference of Python has only the errors: the module is not built")
