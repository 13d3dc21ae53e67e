"""All mutants in one tree: a mutated expression becomes

    (::rigcal_mutant::on(17) ? (mutated) : (original))

and a mutated statement an if with both, so that the tree is built once and an environment variable chooses the
mutant. README.md beside this file describes the tables.
"""

import re
import zlib
from dataclasses import dataclass

SLOTS = 1 << 20

HEADER = """#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

namespace rigcal_mutant {

inline int active() {
  const char* number = std::getenv("RIGCAL_MUTANT");
  return number == nullptr ? -1 : std::atoi(number);
}

/// A byte for every mutant whose place was reached, shared by all processes that write to the file.
inline char* reached() {
  const char* path = std::getenv("RIGCAL_MUTANTS_REACHED");
  const int file = path == nullptr ? -1 : ::open(path, O_RDWR);
  if (file < 0) return nullptr;
  void* bytes = ::mmap(nullptr, SLOTS, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  return bytes == MAP_FAILED ? nullptr : static_cast<char*>(bytes);
}

inline const int kActive = active();
inline char* const kReached = reached();

inline bool on(int mutant) {
  if (kReached != nullptr) kReached[mutant] = 1;
  return mutant == kActive;
}

}  // namespace rigcal_mutant
""".replace("SLOTS", str(SLOTS))


class TableError(Exception):
    """A table that cannot be read, or that no longer fits the sources."""


@dataclass
class Mutant:
    layer: str
    name: str  # unique in its layer
    what: str  # what is broken, in words
    file: str
    original: str = ""
    mutated: str | None = None
    equivalent: str = ""  # why no test can tell, if none can
    type: str = ""  # of both expressions, where the compiler needs to be told

    @property
    def id(self):
        return f"{self.layer}/{self.name}"

    @property
    def number(self):
        """That of a name does not change with its neighbours: sources that did not change stay as they are."""
        return zlib.crc32(self.id.encode()) % SLOTS


def read_table(path):
    """The mutants of tests/mutants/<layer>.txt."""
    mutants, file = [], None
    for number, line in enumerate(path.read_text().splitlines(), 1):
        where = f"{path.name}:{number}"
        kind, rest = line[:2], line[2:].strip()
        if not line.strip() or line.startswith("#"):
            continue
        if line.startswith("== "):
            file = line[3:].strip()
        elif kind in ("- ", "+ ", "= ", ": ") or line in ("-", "+"):
            if not mutants or mutants[-1].file != file:
                raise TableError(f"{where}: a mutant begins with its name")
            field = {"-": "original", "+": "mutated", "=": "equivalent", ":": "type"}[line[0]]
            before = getattr(mutants[-1], field)
            setattr(mutants[-1], field, f"{before} {rest}" if before else rest)
        else:
            match = re.fullmatch(r"([a-z0-9_]+): (.+)", line)
            if not match or file is None:
                raise TableError(f"{where}: expected 'name: what is broken' under a line '== file'")
            mutants.append(Mutant(path.stem, match[1], match[2], file))
    for mutant in mutants:
        if not mutant.original or mutant.mutated in (None, mutant.original):
            raise TableError(f"{mutant.id}: needs a line '- original' and another text in '+ mutated'")
    return mutants


def blanked(source, literals):
    """The source with comments as blanks, and strings and characters too if asked for; of the same length."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|R"\((?:.*?)\)"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-zA-Z])\'(?:\\.|[^\'\\])+\'', re.S)

    def blank(match):
        text = match[0]
        if text.startswith(("//", "/*")):
            return re.sub(r"[^\n]", " ", text)
        return re.sub(r"[^\n]", "_", text) if literals else text

    return pattern.sub(blank, source)


def find(mutant, source):
    """The only place of the original in a source without comments, whatever its white space: (begin, end)."""
    words = [re.escape(word) for word in mutant.original.split()]
    places = [m.span() for m in re.finditer(r"\s+".join(words), source)]
    if len(places) != 1:
        raise TableError(f"{mutant.id}: the original is found {len(places)} times in {mutant.file}, not once")
    return places[0]


def changed(mutant, text):
    """What differs, in the text of the source that the original matches: (begin, end, what stands there instead)."""
    original, mutated = mutant.original, mutant.mutated
    least = min(len(original), len(mutated))
    front = next((i for i in range(least) if original[i] != mutated[i]), least)
    back = next((i for i in range(least - front) if original[-1 - i] != mutated[-1 - i]), least - front)

    def alike(part, of):
        """How long a prefix of `of` has the characters of `part`, whatever its white space."""
        at, characters = 0, len("".join(part.split()))
        while characters > 0 or (part[-1:].isspace() and of[at:at + 1].isspace()):
            characters -= not of[at].isspace()
            at += 1
        return at

    begin = alike(original[:front], text)
    end = len(text) - alike(original[len(original) - back:][::-1], text[::-1])
    return begin, max(begin, end), mutated[front:len(mutated) - back]


OPEN, CLOSE = "([{", ")]}"
BEFORE_A_CONDITION = re.compile(r"\b(?:if|for|while|switch)\s*$")
IS_STATEMENT = re.compile(r"(?:if|for|while|switch|return|throw|continue|break)\b")
ENDS_IN_A_KEYWORD = re.compile(r"\b(?:return|else|throw|case)\s*$")


def is_assignment(text, i):
    return text[i] == "=" and text[i - 1] not in "=!<>" and text[i + 1] != "="


def balanced(text, begin, end):
    """The range, grown until it holds both of each pair of brackets."""
    closed = opened = 0
    for c in text[begin:end]:
        if c in OPEN:
            opened += 1
        elif c in CLOSE and opened:
            opened -= 1
        elif c in CLOSE:
            closed += 1
    while closed:
        begin -= 1
        closed += (text[begin] in CLOSE) - (text[begin] in OPEN)
    while opened:
        opened += (text[end] in OPEN) - (text[end] in CLOSE)
        end += 1
    return begin, end


def expression_around(text, begin, end):
    """The smallest complete expression that holds text[begin:end], or None where that takes a statement.

    It ends at brackets, commas, assignments and the parts of ?:, unless the changed text has those itself.
    """
    begin, end = balanced(text, begin, end)
    inner, depth = set(), 0
    for i in range(begin, end):
        c = text[i]
        depth += (c in OPEN) - (c in CLOSE)
        if c == ";" or is_assignment(text, i):
            return None
        if depth == 0 and (c in ",?" or (c == ":" and ":" not in (text[i - 1], text[i + 1]))):
            inner.add(":" if c == "?" else c)

    def stops(i):
        c = text[i]
        colon = c == ":" and ":" not in (text[i - 1], text[i + 1])
        return c in ";" or is_assignment(text, i) or (c == "," and "," not in inner) or (
            (c == "?" or colon) and ":" not in inner)

    left = begin
    while left > 0:
        c = text[left - 1]
        if c in CLOSE:
            if c == "}":
                break
            start, depth = left - 1, 1
            while depth:
                start -= 1
                depth += (text[start] in CLOSE) - (text[start] in OPEN)
            if BEFORE_A_CONDITION.search(text[:start]):
                break
            left = start
        elif c in OPEN or stops(left - 1) or ENDS_IN_A_KEYWORD.search(text[:left]):
            break
        else:
            left -= 1
    right, depth = end, 0
    while depth or not (text[right] in CLOSE or stops(right)):
        depth += (text[right] in OPEN) - (text[right] in CLOSE)
        right += 1
    if "," in inner and text[right] in CLOSE and text[left - 1] in OPEN:
        return expression_around(text, left - 1, right + 1)  # of the call
    if is_assignment(text, right):
        return None
    left += len(text[left:right]) - len(text[left:right].lstrip())
    right -= len(text[left:right]) - len(text[left:right].rstrip())
    return left, right


def statement_around(text, begin, end):
    """From after the statement before to the semicolon or brace that ends this one."""
    left, right = balanced(text, begin, end)
    depth = 0
    while depth or text[left - 1] not in ";{}":
        left -= 1
        depth += (text[left] in ")]") - (text[left] in "([")
    depth = 0
    while depth or text[right - 1] not in ";}":
        depth += (text[right] in OPEN) - (text[right] in CLOSE)
        right += 1
    of_initialiser = re.compile(r"\s*;").match(text, right)  # what ends in its brace, ends after it
    if text[right - 1] == "}" and of_initialiser:
        right = of_initialiser.end()
    left += len(text[left:right]) - len(text[left:right].lstrip())
    return left, right


@dataclass
class Place:
    begin: int
    end: int
    is_statement: bool
    mutants: list  # (mutant, mutated text of the place)


def places_of(mutants, source):
    """Where the mutants of one file go; those of one expression together."""
    code, shape = blanked(source, literals=False), blanked(source, literals=True)
    places = {}
    for mutant in mutants:
        begin, end = find(mutant, code)
        first, last, instead = changed(mutant, code[begin:end])
        first, last = begin + first, begin + last
        region = None if ";" in instead else expression_around(shape, first, last)
        if region and IS_STATEMENT.match(code[region[0]:first] + instead + code[last:region[1]]):
            region = None
        left, right = region or statement_around(shape, first, last)
        replaced = code[left:first] + instead + code[last:right]
        is_statement = region is None
        place = places.setdefault((left, right), Place(left, right, is_statement, []))
        if place.is_statement != is_statement:
            raise TableError(f"{mutant.id}: {mutant.file} is mutated there as expression and as statement")
        place.mutants.append((mutant, replaced))
    ordered = sorted(places.values(), key=lambda place: (place.begin, -place.end))
    for i, place in enumerate(ordered):
        for other in ordered[i + 1:]:
            if place.begin < other.begin < place.end < other.end:
                names = place.mutants[0][0].id, other.mutants[0][0].id
                raise TableError(f"{names[0]} and {names[1]} overlap")
    return code, ordered


def rendered(code, places, begin, end):
    """code[begin:end] with the places, which lie within it and are ordered, mutated."""
    out, at, i = [], begin, 0
    while i < len(places):
        place = places[i]
        inner = [p for p in places[i + 1:] if p.end <= place.end and p.begin >= place.begin]
        out.append(code[at:place.begin])
        original = rendered(code, inner, place.begin, place.end)
        for mutant, text in place.mutants:
            test = f"::rigcal_mutant::on({mutant.number})"
            if place.is_statement:
                original = f"if ({test}) {{ {text} }} else {{ {original} }}"
            else:
                cast = mutant.type
                original = f"({test} ? {cast}({text}) : {cast}({original}))"
        out.append(original)
        at = place.end
        i += 1 + len(inner)
    out.append(code[at:end])
    return "".join(out)


def without_constexpr(code, places):
    """A constant whose value is mutated is one of run time: (begin, end, what stands there instead), the last first."""
    edits = set()
    for place in places:
        match = re.search(r"\b(inline |static |)constexpr (?=[^;()]*$)", code[:place.begin])
        if match:
            storage = {"inline ": "inline ", "static ": "static inline ", "": ""}[match[1]]
            edits.add((match.start(), match.end(), f"{storage}const "))
    return sorted(edits, reverse=True)


def with_mutants(source, mutants):
    """The source with all of its mutants."""
    code, places = places_of(mutants, source)
    text = rendered(code, places, 0, len(code))
    for left, right, replacement in without_constexpr(code, places):
        before = rendered(code, [p for p in places if p.end <= left], 0, left)
        start = len(before)
        text = text[:start] + replacement + text[start + right - left:]
    return '#include "rigcal_mutant.hpp"\n' + text


def check(mutants, root):
    """TableError where a table no longer fits the sources below root."""
    numbers = {}
    for mutant in mutants:
        other = numbers.setdefault(mutant.number, mutant)
        if other is not mutant:
            raise TableError(f"{mutant.id} and {other.id}: choose another name, theirs are not told apart")
    for file, here in by_file(mutants).items():
        if not (root / file).is_file():
            raise TableError(f"{here[0].id}: no file {file}")
        with_mutants((root / file).read_text(), here)


def by_file(mutants):
    files = {}
    for mutant in mutants:
        files.setdefault(mutant.file, []).append(mutant)
    return files
