"""All mutants in one tree: a mutated expression becomes

    (::rigcal_mutant::on(17) ? (mutated) : (original))

and a mutated statement an if with both, so that the tree is built once and an environment variable chooses the
mutant. README.md beside this file describes the tables.
"""

import difflib
import re
import zlib
from dataclasses import dataclass

SLOTS = 1 << 20

HEADER = """#pragma once

#ifdef __wasm__
// The model in a page reads no environment, and its tests take no part.
namespace rigcal_mutant {
inline bool on(int /*mutant*/) { return false; }
}  // namespace rigcal_mutant
#else

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

#endif
""".replace("SLOTS", str(SLOTS))


class TableError(Exception):
    """A table that cannot be read, or that no longer fits the sources."""


@dataclass
class Mutant:
    layer: str
    name: str  # unique in its layer
    what: str  # what is broken, in words
    file: str
    function: str = ""  # every function of this name in the file; empty: the whole file
    original: str = ""
    mutated: str | None = None
    equivalent: str = ""  # why no test can detect it; empty if one can
    type: str = ""  # common type of the expressions, where the compiler needs it

    @property
    def id(self):
        return f"{self.layer}/{self.name}"

    @property
    def number(self):
        """Depends only on the name, so that sources do not change if other mutants do, and need
        not be compiled again."""
        return zlib.crc32(self.id.encode()) % SLOTS


def read_table(path):
    """Returns the mutants in tests/mutants/<layer>.txt."""
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
            match = re.fullmatch(r"([a-z0-9_]+)(?: @ (\w+))?: (.+)", line)
            if not match or file is None:
                raise TableError(f"{where}: expected 'name @ function: what is broken' under a line '== file'")
            mutants.append(Mutant(path.stem, match[1], match[3], file, match[2] or ""))
    for mutant in mutants:
        if not mutant.original or mutant.mutated in (None, mutant.original):
            raise TableError(f"{mutant.id}: needs a line '- original' and another text in '+ mutated'")
    return mutants


def blanked(source, literals):
    """Returns the source, at the same length, with blanks instead of comments and, if
    `literals`, of strings and characters."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|R"\((?:.*?)\)"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-zA-Z])\'(?:\\.|[^\'\\])+\'', re.S)

    def blank(match):
        text = match[0]
        if text.startswith(("//", "/*")):
            return re.sub(r"[^\n]", " ", text)
        return re.sub(r"[^\n]", "_", text) if literals else text

    return pattern.sub(blank, source)


OPEN, CLOSE = "([{", ")]}"
NO_FUNCTIONS = {"if", "for", "while", "switch", "catch", "return", "sizeof", "decltype", "alignas"}
TOKEN = re.compile(r'''R"\((?:.*?)\)"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\])+'|\.?\d(?:[eEpP][+-]|'?[\w.])*|\w+'''
                   r"|<=>|<<=|>>=|->\*|\.\.\.|::|->|\+\+|--|<<|>>|&&|\|\||[-+*/%&|^=!<>]=|\S", re.S)


@dataclass(frozen=True)
class Token:
    text: str
    begin: int
    end: int


def tokens_of(code):
    """Returns the tokens of a text without comments, ignoring white space and line breaks."""
    return [Token(m[0], *m.span()) for m in TOKEN.finditer(code)]


def closing(tokens, i):
    """Returns the index of the bracket that closes tokens[i], or the end of the tokens."""
    depth = 0
    for j in range(i, len(tokens)):
        depth += (tokens[j].text in OPEN) - (tokens[j].text in CLOSE)
        if depth == 0:
            return j
    return len(tokens)


def definition_end(tokens, i):
    """Returns the index of the brace that ends the function with the name tokens[i]; None if this is no definition."""
    if i + 1 == len(tokens) or tokens[i + 1].text != "(":
        return None
    i, initialises = closing(tokens, i + 1) + 1, False
    while i < len(tokens):
        text = tokens[i].text
        if text == "{" and not (initialises and re.match(r"\w|>", tokens[i - 1].text)):
            return closing(tokens, i)
        if text in "([{":
            i = closing(tokens, i)
        elif text == ":":
            initialises = True
        elif not re.fullmatch(r"\w+|->|::|[&*<>,.]|&&|>>|\.\.\.", text) or (text == "," and not initialises):
            return None
        i += 1
    return None


def functions_of(tokens):
    """Returns (name, index of the name, index of the closing brace) of every function that the tokens define."""
    found = []
    for i, token in enumerate(tokens):
        if re.fullmatch(r"[A-Za-z_]\w*", token.text) and token.text not in NO_FUNCTIONS:
            end = definition_end(tokens, i)
            if end is not None and (i == 0 or tokens[i - 1].text not in (".", "->", "return", "else", ":", ",")):
                found.append((token.text, i, end))
    return found


def sequences(wanted, tokens, begin, end):
    """Returns the indices at which the texts occur in tokens[begin:end]."""
    first, count = wanted[0], len(wanted)
    return [i for i in range(begin, end - count + 1)
            if tokens[i].text == first and [t.text for t in tokens[i:i + count]] == wanted]


def nearest(wanted, tokens, begin, end, code):
    """Returns the part of tokens[begin:end] most similar to the texts, as "line 12: text"."""
    count = min(len(wanted), end - begin)
    matcher = difflib.SequenceMatcher(autojunk=False)
    matcher.set_seq2(wanted)
    best, at = (0.0, 0), None
    for i in range(begin, end - count + 1):
        texts = [t.text for t in tokens[i:i + count]]
        matcher.set_seq1(texts)
        if matcher.quick_ratio() >= best[0]:
            best, at = max((best, at), ((matcher.ratio(), sum(map(str.__eq__, texts, wanted))), i),
                           key=lambda likeness: likeness[0])
    return told(tokens[at], tokens[at + count - 1], code) if at is not None else "nothing like it"


def told(first, last, code):
    text = " ".join(code[first.begin:last.end].split())
    return f"line {code.count(chr(10), 0, first.begin) + 1}: {text}"


def find(mutant, tokens, functions, code):
    """Returns the first token of the only occurrence of the original in its function, or in the file if none is given."""
    wanted = [t.text for t in tokens_of(mutant.original)]
    bodies = [(i, end) for name, i, end in functions if name == mutant.function]
    whole = [(0, len(tokens))]
    where = f"{mutant.function}() of {mutant.file}" if mutant.function else mutant.file
    if mutant.function and not bodies:
        elsewhere = sequences(wanted, tokens, 0, len(tokens))
        of = sorted({name for name, i, end in functions for at in elsewhere if i <= at <= end})
        like = of or difflib.get_close_matches(mutant.function, {name for name, _, _ in functions})
        raise TableError(f"{mutant.id}: no function {mutant.function}() in {mutant.file}"
                         + (f"; the original stands in {', '.join(of)}()" if of else
                            f"; nearest: {', '.join(like)}()" if like else ""))
    places = sorted({i for begin, end in bodies or whole for i in sequences(wanted, tokens, begin, end)})
    if not places:
        candidates = [nearest(wanted, tokens, begin, end, code) for begin, end in bodies or whole]
        raise TableError(f"{mutant.id}: lost its place in {where}:\n  wanted   {' '.join(mutant.original.split())}\n"
                         + "\n".join(f"  nearest  {candidate}" for candidate in candidates))
    if len(places) > 1:
        raise TableError(f"{mutant.id}: the original stands {len(places)} times in {where}, not once:\n" + "\n".join(
            f"  {told(tokens[i], tokens[i + len(wanted) - 1], code)}" for i in places))
    return places[0]


def changed(mutant, tokens, at):
    """Returns the change as (begin, end, replacement) in the source, whose tokens match the original from `at` on."""
    original, mutated = tokens_of(mutant.original), tokens_of(mutant.mutated)
    least = min(len(original), len(mutated))
    front = next((i for i in range(least) if original[i].text != mutated[i].text), least)
    back = next((i for i in range(least - front) if original[-1 - i].text != mutated[-1 - i].text), least - front)
    last, last_mutated = len(original) - back, len(mutated) - back
    instead = mutant.mutated[mutated[front].begin:mutated[last_mutated - 1].end] if front < last_mutated else ""
    if front == last:  # a pure insertion
        begin = tokens[at + front].begin if front < len(original) else tokens[at + front - 1].end
        return begin, begin, f" {instead} "
    if not mutated and original[-1].text == ";":
        instead = "{;}"  # a loop or condition without braces keeps a statement, without a warning
    return tokens[at + front].begin, tokens[at + last - 1].end, instead


BEFORE_A_CONDITION = re.compile(r"\b(?:if|for|while|switch)\s*$")
IS_STATEMENT = re.compile(r"(?:if|for|while|switch|return|throw|continue|break)\b")
ENDS_IN_A_KEYWORD = re.compile(r"\b(?:return|else|throw|case)\s*$")


def ends_in_a_keyword(text, end):
    """Whether a keyword stands before the end, which does not lie within a name such as `cases`."""
    found = ENDS_IN_A_KEYWORD.search(text[:end])
    return found is not None and not (text[end - 1].isalpha() and re.match(r"\w", text[end:]))


def is_assignment(text, i):
    return text[i] == "=" and text[i - 1] not in "=!<>" and text[i + 1] != "="


def balanced(text, begin, end):
    """Returns the range, extended until it contains both of each pair of brackets."""
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
    """Returns the smallest complete expression that contains text[begin:end], or None if that needs a statement.

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
            start, depth = left - 1, 1
            while depth:
                start -= 1
                depth += (text[start] in CLOSE) - (text[start] in OPEN)
            if c == "}" and not re.match(r"[\w>]", text[start - 1]):
                break  # the brace belongs to a block, not to an initialiser
            if BEFORE_A_CONDITION.search(text[:start]):
                break
            left = start
        elif c in OPEN or stops(left - 1) or ends_in_a_keyword(text, left):
            break
        else:
            left -= 1
    right, depth = end, 0
    while depth or not (text[right] in CLOSE or stops(right)):
        depth += (text[right] in OPEN) - (text[right] in CLOSE)
        right += 1
    if "," in inner and text[right] in CLOSE and text[left - 1] in OPEN:
        return expression_around(text, left - 1, right + 1)  # the whole call
    if is_assignment(text, right):
        return None
    left += len(text[left:right]) - len(text[left:right].lstrip())
    right -= len(text[left:right]) - len(text[left:right].rstrip())
    return left, right


def statement_around(text, begin, end):
    """Returns the range from the end of the previous statement to the semicolon or brace that
    ends this one."""
    left, right = balanced(text, begin, end)
    depth = 0
    while depth or text[left - 1] not in ";{}":
        left -= 1
        depth += (text[left] in ")]") - (text[left] in "([")
    depth = 0
    while depth or text[right - 1] not in ";}":
        depth += (text[right] in OPEN) - (text[right] in CLOSE)
        right += 1
    of_initialiser = re.compile(r"\s*;").match(text, right)  # an initialiser has a semicolon after its brace
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
    """Finds the places of the mutants of one file. Mutants of the same expression share a place."""
    code, shape = blanked(source, literals=False), blanked(source, literals=True)
    tokens = tokens_of(code)
    functions = functions_of(tokens)
    places, lost = {}, []
    for mutant in mutants:
        try:
            at = find(mutant, tokens, functions, code)
        except TableError as error:
            lost.append(str(error))
            continue
        first, last, instead = changed(mutant, tokens, at)
        region = None if ";" in instead else expression_around(shape, first, last)
        if region and any(IS_STATEMENT.match(text.lstrip()) for text in (
                code[region[0]:region[1]], code[region[0]:first] + instead + code[last:region[1]])):
            region = None
        left, right = region or statement_around(shape, first, last)
        replaced = (code[left:first] + instead + code[last:right]).strip()
        is_statement = region is None
        place = places.setdefault((left, right), Place(left, right, is_statement, []))
        if place.is_statement != is_statement:
            raise TableError(f"{mutant.id}: {mutant.file} is mutated there as expression and as statement")
        place.mutants.append((mutant, replaced))
    if lost:
        raise TableError("\n".join(lost))
    ordered = sorted(places.values(), key=lambda place: (place.begin, -place.end))
    for i, place in enumerate(ordered):
        for other in ordered[i + 1:]:
            if place.begin < other.begin < place.end < other.end:
                names = place.mutants[0][0].id, other.mutants[0][0].id
                raise TableError(f"{names[0]} and {names[1]} overlap")
    return code, ordered


def rendered(code, places, begin, end):
    """Returns code[begin:end] with the mutants inserted at the places, which are in order and
    within this range."""
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
    """Returns edits (begin, end, replacement), last first, that turn constants with mutated
    values into run-time constants."""
    edits = set()
    for place in places:
        match = re.search(r"\b(inline |static |)constexpr (?=[^;()]*$)", code[:place.begin])
        if match:
            storage = {"inline ": "inline ", "static ": "static inline ", "": ""}[match[1]]
            edits.add((match.start(), match.end(), f"{storage}const "))
    return sorted(edits, reverse=True)


def with_mutants(source, mutants):
    """Returns the source with all its mutants."""
    code, places = places_of(mutants, source)
    text = rendered(code, places, 0, len(code))
    for left, right, replacement in without_constexpr(code, places):
        before = rendered(code, [p for p in places if p.end <= left], 0, left)
        start = len(before)
        text = text[:start] + replacement + text[start + right - left:]
    return '#include "rigcal_mutant.hpp"\n' + text


def check(mutants, root):
    """Raises TableError if a table does not match the sources in `root`."""
    numbers = {}
    for mutant in mutants:
        other = numbers.setdefault(mutant.number, mutant)
        if other is not mutant:
            raise TableError(f"{mutant.id} and {other.id}: choose another name, theirs are not told apart")
    lost = []
    for file, here in by_file(mutants).items():
        if not (root / file).is_file():
            lost.append(f"{', '.join(mutant.id for mutant in here)}: no file {file}")
            continue
        try:
            with_mutants((root / file).read_text(), here)
        except TableError as error:
            lost.append(str(error))
    if lost:
        raise TableError("\n".join(lost))


def by_file(mutants):
    files = {}
    for mutant in mutants:
        files.setdefault(mutant.file, []).append(mutant)
    return files
