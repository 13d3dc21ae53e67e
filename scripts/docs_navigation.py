"""Lets MkDocs list every decision by its title, so that a new one needs no other file."""
import pathlib


def on_config(config):
    folder = pathlib.Path(config["docs_dir"]) / "decisions"
    titles = ((path.read_text(encoding="utf-8").partition("\n")[0].lstrip("# "), path) for path in sorted(folder.glob("*.md")))
    development = next(part["Development"] for part in config["nav"] if "Development" in part)
    development.append({"Decisions": [{title.replace("`", ""): f"decisions/{path.name}"} for title, path in titles]})
    return config
