#!/usr/bin/env python3
"""The pages as a site in build/docs/site, by MkDocs: `./dev docs` runs this. --arrange: its input alone, no MkDocs.

build/docs/pages is arranged for it:
  index.md            README.md; questions.md is its table of questions and commands
  the rest of docs/   where it is, so that links between pages hold
  source/             each file outside docs/ that a page links: Markdown as a page, a folder as a list, else text
  side-by-side/       C++ and SystemVerilog of each stage
  adr/index.md        the decisions by title
  reference/          what Doxygen made
  web/                the page in the browser, if ./dev web has made it
Exit status: 0, or 1 with each page that docs/mkdocs.yml does not list and each link of the site that leads nowhere.
"""

import html.parser
import json
import os
import pathlib
import posixpath
import re
import shutil
import subprocess
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES, SITE = ROOT / "build/docs/pages", ROOT / "build/docs/site"
LINK = re.compile(r"(\]\()([^)\s]+)(\))")
FENCE = re.compile(r" *```")
LIST_ITEM = re.compile(r" *([-*]|\d+\.) ")

STYLE = """
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 1rem; font-size: 85%; }
.pair > div { min-width: 0; }
.pair code { white-space: pre; }
.md-typeset table:not([class]) { font-size: .7rem; }
"""


def place(path):
    """Where the file or folder `path` of the project, relative to its root, stands in the site's pages."""
    if path == "README.md":
        return "index.md"
    if path == "web/site" or path.startswith("web/site/"):
        return "web" + path[len("web/site"):]
    if path.startswith("docs/"):
        return path[len("docs/"):]
    if (ROOT / path).is_dir():
        return f"source/{path}/index.md"
    return f"source/{path}" + ("" if path.endswith(".md") else ".txt")


def as_python_markdown(text):
    """What GitHub's Markdown allows and Python-Markdown does not: lists and tables that follow a paragraph at once,
    items whose contents are indented by two or three columns, Markdown inside of <details>."""
    lines, is_in_fence, extra = [], False, 0
    for line in text.split("\n"):
        indent = len(line) - len(line.lstrip(" "))
        if not is_in_fence:
            extra = 4 - indent if indent in (2, 3) else 0
            previous = lines[-1] if lines else ""
            begins_list = LIST_ITEM.match(line) and not LIST_ITEM.match(previous) and not previous.startswith(" ")
            begins_table = line.startswith("|") and not previous.startswith("|")
            if previous and indent == 0 and (begins_list or begins_table):
                lines.append("")
        if FENCE.match(line):
            is_in_fence = not is_in_fence
        lines.append(" " * extra + line if line else line)
    return "\n".join(lines).replace("<details><summary>", '<details markdown="1">\n<summary>')


class Pages:
    """The pages to write, and the files that they link."""

    def __init__(self):
        self.waiting = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"]
        self.waiting += [p.relative_to(ROOT).as_posix() for p in sorted((ROOT / "docs").rglob("*.md"))]
        self.known = set(self.waiting)

    def write(self, target, text):
        path = PAGES / target
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def link(self, target, source_folder, page):
        """The link `target` of a page in `source_folder` as the page `page` of the site has it."""
        url, hash_sign, anchor = target.partition("#")
        if "://" in target or not url:
            return target
        path = posixpath.normpath(posixpath.join(source_folder, url))
        if path not in self.known and not path.startswith(("docs/", "web/site")):
            self.known.add(path)
            self.waiting.append(path)
        to = place(path)
        if path.startswith("docs/") and (ROOT / path).is_dir():
            self.list_folder(path, to := to + "/index.md")
        return posixpath.relpath(to, posixpath.dirname(page) or ".") + hash_sign + anchor

    def page(self, path, page, text):
        folder = posixpath.dirname(path)
        text = LINK.sub(lambda m: m[1] + self.link(m[2], folder, page) + m[3], text)
        self.write(page, as_python_markdown(text))

    def list_folder(self, path, page):
        names = sorted(p.name + "/" * p.is_dir() for p in (ROOT / path).iterdir() if p.name != "__pycache__")
        self.page(f"{path}/", page, f"# {path}\n\n" + "".join(f"- [{name}]({name})\n" for name in names))

    def all(self):
        while self.waiting:
            path = self.waiting.pop()
            source = ROOT / path
            if source.is_dir():
                self.list_folder(path, place(path))
            elif path.endswith(".md"):
                self.page(path, place(path), source.read_text())
            else:
                target = PAGES / place(path)
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, target)


def section(text, begin, end):
    """The lines of `text` from the one with `begin` to the one before the next with `end`."""
    lines = text.split("\n")
    first = next(i for i, line in enumerate(lines) if begin in line)
    return "\n".join(lines[first:next(i for i in range(first + 1, len(lines)) if end in lines[i])])


def pair(title, left, right, intro=""):
    """A page of two columns, each a list of (name, language, text)."""
    columns = ""
    for column in (left, right):
        files = "".join(f"**{name}**\n\n```{language}\n{text.rstrip()}\n```\n\n" for name, language, text in column)
        columns += f'<div markdown="1">\n\n{files}</div>\n\n'
    head = "---\nhide: [navigation, toc]\n---\n<style>.md-grid { max-width: 120rem; }</style>\n"
    return f'{head}\n# {title}\n\n{intro}\n\n<div class="pair" markdown="1">\n\n{columns}</div>\n'


def side_by_side(pages):
    """A page for each stem that model/stages and rtl_ref/stages share; the edge function first."""
    model, rtl = ROOT / "model/stages", ROOT / "rtl_ref/stages"

    def whole(path, language):
        return path.relative_to(ROOT).as_posix(), language, path.read_text()

    cull = (rtl / "cull.sv").read_text()
    fine = (rtl / "fine_raster.sv").read_text()
    intro = ("In C++ one function for every pixel. The circuit computes it once for each edge, at the first pixel of "
             "the first tile ([cull](cull.md)); from there on it adds `step_x` and `step_y` "
             "([coarse_raster](coarse_raster.md), [fine_raster](fine_raster.md)).")
    edge = section(cull, "Steps 1 to 3, edge_function", "-- decide")
    pages.write("side-by-side/edge_function.md",
                pair("The edge function", [whole(model / "edge_function.hpp", "cpp")],
                     [("rtl_ref/stages/cull.sv, its steps 1 to 3", "systemverilog", edge),
                      ("rtl_ref/stages/fine_raster.sv", "systemverilog", fine)], intro))
    rows = "| [edge_function](edge_function.md) | the side of an edge on which a sample lies |\n"
    for file in sorted(rtl.glob("*.sv")):
        stem = file.stem.removesuffix("_serial")
        left = [whole(p, "cpp") for p in (model / f"{stem}.hpp", model / f"{stem}.cpp") if p.exists()]
        if not left:
            continue
        text = file.read_text()
        head = text.split("\n//\n")[0].split("\nmodule ")[0]
        comment = " ".join(line[3:] for line in head.split("\n") if line.startswith("//"))
        rows += f"| [{file.stem}]({file.stem}.md) | {comment} |\n"
        pages.write(f"side-by-side/{file.stem}.md", pair(file.stem, left, [whole(file, "systemverilog")]))
    pages.write("side-by-side/index.md",
                "# C++ and SystemVerilog side by side\n\nEach stage is written twice: as C++ that says what every bit "
                "is, and as the circuit that computes it. Both have the same stem; exceptions are in "
                "[rtl_ref/README.md](../source/rtl_ref/README.md#stems). `halfplane cosim` compares their packets.\n\n"
                "| stage | what it does, from the head of its circuit |\n| --- | --- |\n" + rows)


def decisions(pages):
    text = "# Decisions\n\nOne a page: what was decided, why, and what was weighed against it.\n\n"
    for path in sorted((ROOT / "docs/adr").glob("*.md")):
        title = re.match(r"# (?:ADR )?\d+[.:] (.*)", path.read_text())[1]
        text += f"- {int(path.name[:4])}: [{title}]({path.name})\n"
    pages.write("adr/index.md", text)


def keep_code_out_of_the_search():
    path = SITE / "search/search_index.json"
    index = json.loads(path.read_text())
    for entry in index["docs"]:
        if entry["location"].startswith("side-by-side/") and "index.html" not in entry["location"]:
            entry["text"] = ""
    path.write_text(json.dumps(index, ensure_ascii=False))


class Links(html.parser.HTMLParser):
    """The links and anchors of an HTML page."""

    def __init__(self, path):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src") and value is not None:
                self.links.append(value)
            if name == "id" or (tag == "a" and name == "name"):
                self.anchors.add(value)


def dead_links():
    """Links of the site, Doxygen's and the web page's files excepted, to a file or an anchor that is not there."""
    pages = {p: Links(p) for p in SITE.rglob("*.html")
             if p.relative_to(SITE).parts[0] not in ("reference", "web") and p.name != "404.html"}
    for path, page in pages.items():
        for link in page.links:
            url = urllib.parse.urlsplit(link)
            if url.scheme or url.netloc:
                continue
            target = pathlib.Path(os.path.normpath(path.parent / urllib.parse.unquote(url.path))) if url.path else path
            if target.is_dir():
                target /= "index.html"
            if not target.exists() or (url.fragment and target in pages and url.fragment not in pages[target].anchors):
                yield f"{path.relative_to(SITE)}: {link}"


def main():
    shutil.rmtree(PAGES, ignore_errors=True)
    shutil.copytree(ROOT / "docs", PAGES, ignore=shutil.ignore_patterns("*.md", "Doxyfile", "mkdocs.yml"))
    pages = Pages()
    pages.all()
    readme = (ROOT / "README.md").read_text()
    questions = section(readme, "## What it answers", "## ")
    questions = questions.replace("## What it answers", "# Which command answers my question", 1)
    pages.page("README.md", "questions.md", questions)
    side_by_side(pages)
    decisions(pages)
    pages.write("site.css", STYLE)
    for made, where, command in (("docs/html", "reference", "./dev docs"), ("web/site", "web", "./dev web")):
        if (ROOT / "build" / made).is_dir():
            shutil.copytree(ROOT / "build" / made, PAGES / where)
        else:
            text = f"<!doctype html><title>Halfplane</title><p><code>{command}</code> makes this page.\n"
            pages.write(f"{where}/index.html", text)
    nav = (ROOT / "docs/mkdocs.yml").read_text()
    listed = [p.relative_to(ROOT / "docs").as_posix() for p in (ROOT / "docs").rglob("*.md") if p.parent.name != "adr"]
    faults = [f"docs/mkdocs.yml does not list {name}" for name in listed if f" {name}\n" not in nav]
    if not faults and "--arrange" not in sys.argv:
        command = ["mkdocs", "build", "--quiet", "--strict", "--config-file", ROOT / "docs/mkdocs.yml"]
        if subprocess.run(command).returncode != 0:
            return 1
        keep_code_out_of_the_search()
        faults = list(dead_links())
    print("\n".join(faults), end="\n" * bool(faults), file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
