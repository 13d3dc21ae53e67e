"""What becomes of a mutated place: the meaning without the mutant must stay."""

import re
import unittest

import schemata


def inserted(source, *pairs):
    """The source with mutants (original, mutated), each test as its name M0, M1, .."""
    mutants = [schemata.Mutant("layer", f"m{i}", "", "file", a, b) for i, (a, b) in enumerate(pairs)]
    text = schemata.with_mutants(source, mutants).partition("\n")[2]
    for i, mutant in enumerate(mutants):
        text = text.replace(f"::rigcal_mutant::on({mutant.number})", f"M{i}")
    return re.sub(r"\s+", " ", text).strip()


class Schemata(unittest.TestCase):
    def test_an_expression_is_taken_whole(self):
        self.assertEqual(inserted("x = a - b - c * d;", ("b - c", "b + c")),
                         "x = (M0 ? (a - b + c * d) : (a - b - c * d));")
        self.assertEqual(inserted("return f(a < b, c);", ("a < b", "a <= b")), "return f((M0 ? (a <= b) : (a < b)), c);")
        self.assertEqual(inserted("y += k ? a * 2.0 : b;", ("a * 2.0", "a * 3.0")),
                         "y += k ? (M0 ? (a * 3.0) : (a * 2.0)) : b;")
        self.assertEqual(inserted("if (a && b) return;", ("a && b", "a")), "if ((M0 ? (a) : (a && b))) return;")

    def test_exchanged_arguments_take_the_call(self):
        self.assertEqual(inserted("x = 1 + f(a, b);", ("f(a, b)", "f(b, a)")), "x = (M0 ? (1 + f(b, a)) : (1 + f(a, b)));")

    def test_statements(self):
        self.assertEqual(inserted("{ a = 1; b = 2; }", ("b = 2;", "")), "{ a = 1; if (M0) { } else { b = 2; } }")
        self.assertEqual(inserted("{ if (c) a += b; }", ("a += b", "a -= b")),
                         "{ if (M0) { if (c) a -= b; } else { if (c) a += b; } }")

    def test_a_statement_that_ends_in_an_initialiser(self):
        self.assertEqual(inserted("{ if (c) { a = {0, b}; } d(); }", ("a = {0, b};", ";")),
                         "{ if (c) { if (M0) { ; } else { a = {0, b}; } } d(); }")

    def test_mutants_of_one_expression_and_within_another(self):
        self.assertEqual(inserted("x = a + f(b + c);", ("a + f(", "a - f("), ("b + c", "b - c"), ("a + f(", "2 + f(")),
                         "x = (M2 ? (2 + f(b + c)) : ((M0 ? (a - f(b + c)) : (a + f((M1 ? (b - c) : (b + c)))))));")

    def test_constants_become_values_of_run_time(self):
        self.assertEqual(inserted("constexpr double kA = 8.0;", ("kA = 8.0", "kA = 9.0")),
                         "const double kA = (M0 ? (9.0) : (8.0));")

    def test_comments_and_white_space_do_not_count(self):
        self.assertEqual(inserted("// a + b\nx = a +\n  b;", ("a + b", "a * b")), "x = (M0 ? (a * b) : (a + b));")

    def test_what_is_not_there_once_is_refused(self):
        for source in ("x = a;", "x = a + b; y = a + b;"):
            with self.assertRaises(schemata.TableError):
                inserted(source, ("a + b", "a - b"))


unittest.main()
