"""Tests how mutants are inserted. If no mutant is active, the meaning of the code must not
change."""

import re
import unittest

import schemata


def inserted(source, *pairs, function=""):
    """Returns the source with mutants (original, mutated), in which their tests are named M0,
    M1, ..."""
    mutants = [schemata.Mutant("layer", f"m{i}", "", "file", function, a, b) for i, (a, b) in enumerate(pairs)]
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

    def test_a_name_may_begin_as_a_keyword_does(self):
        self.assertEqual(inserted("x = a && cases.b == c;", ("cases.b == c", "cases.b != c")),
                         "x = (M0 ? (a && cases.b != c) : (a && cases.b == c));")
        self.assertEqual(inserted("if (a) throw(b + c);", ("throw(b + c)", "throw(b - c)")),
                         "if (a) throw((M0 ? (b - c) : (b + c)));")

    def test_an_initialiser_is_part_of_its_expression(self):
        self.assertEqual(inserted("{ f(); } x = T{1} << 3;", ("<< 3", "<< 4")),
                         "{ f(); } x = (M0 ? (T{1} << 4) : (T{1} << 3));")
        self.assertEqual(inserted("{ f(); } if (e == E{} && b) g();", ("&& b", "")),
                         "{ f(); } if ((M0 ? (e == E{}) : (e == E{} && b))) g();")
        self.assertEqual(inserted("{ f(); } a + b;", ("a + b", "a - b")), "{ f(); } (M0 ? (a - b) : (a + b));")

    def test_exchanged_arguments_take_the_call(self):
        self.assertEqual(inserted("x = 1 + f(a, b);", ("f(a, b)", "f(b, a)")), "x = (M0 ? (1 + f(b, a)) : (1 + f(a, b)));")

    def test_statements(self):
        self.assertEqual(inserted("{ a = 1; b = 2; }", ("b = 2;", "")), "{ a = 1; if (M0) { {;} } else { b = 2; } }")
        self.assertEqual(inserted("{ for (a : b) c(a); }", ("c(a);", "")),
                         "{ if (M0) { for (a : b) {;} } else { for (a : b) c(a); } }")
        self.assertEqual(inserted("{ if (c) a += b; }", ("a += b", "a -= b")),
                         "{ if (M0) { if (c) a -= b; } else { if (c) a += b; } }")

        self.assertEqual(inserted("{ if (c) f(a); }", ("if (c) f(a);", "f(a);")), "{ if (M0) { f(a); } else { if (c) f(a); } }")

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
        self.assertEqual(inserted("x = f( a, /* more */\n  b );", ("f(a,b)", "f(a,c)")), "x = f( a, (M0 ? (c) : (b)) );")
        self.assertEqual(inserted("x = a+b;", ("a + b", "a + 2 * b")), "x = (M0 ? (a+ 2 * b) : (a+b));")

    def test_a_part_of_a_token_is_no_place(self):
        self.assertEqual(inserted("x = aa + b; y = a + b; z = a + bb;", ("a + b", "a - b")),
                         "x = aa + b; y = (M0 ? (a - b) : (a + b)); z = a + bb;")
        self.assertEqual(inserted("x = 1.05 * a; y = 1.0 * a;", ("1.0", "2.0")), 
                         "x = 1.05 * a; y = (M0 ? (2.0 * a) : (1.0 * a));")
        with self.assertRaises(schemata.TableError):
            inserted("x += a;", ("= a", "= b"))

    def test_what_is_not_there_once_is_refused(self):
        for source in ("x = a;", "x = a + b; y = a + b;"):
            with self.assertRaises(schemata.TableError):
                inserted(source, ("a + b", "a - b"))

    def test_the_original_counts_within_its_function(self):
        first = "int first(int a) { return a + b; }"
        for second in ("int second(int a) const noexcept { %s }", "auto C::second(std::map<int, K>& a) -> int { %s }",
                       "C::second(int a) : x_(a), y_{f(a), b} { %s }"):
            source = f"int second(int a); {first} {second % 'return a + b;'} int third() {{ return second(a + b) + 1; }}"
            mutated = f"int second(int a); {first} {second % 'return (M0 ? (a - b) : (a + b));'} " \
                      "int third() { return second(a + b) + 1; }"
            self.assertEqual(inserted(source, ("a + b", "a - b"), function="second"), mutated)

    def test_functions_of_one_name_count_together(self):
        both = "int f(int a) { return a + 1; } int f(double a) { return a + %s; }"
        self.assertEqual(inserted(both % "2", ("a + 2", "a - 2"), function="f"),
                         "int f(int a) { return a + 1; } int f(double a) { return (M0 ? (a - 2) : (a + 2)); }")
        with self.assertRaises(schemata.TableError):
            inserted(both % "1", ("a + 1", "a - 1"), function="f")

    def test_what_does_not_matter_moves(self):
        before = 'void f() { if (a > kMost) throw Error("too large"); g(); } void g() { if (a > kMost) h(); }'
        after = '// Now said better.\nvoid e() { a > kMost; } void f() { g(); other();\n' \
                ' if (a\n > kMost) throw Error("at most {}", kMost); }'
        mutant = ("a > kMost", "a >= kMost")
        self.assertIn("if ((M0 ? (a >= kMost) : (a > kMost))) throw", inserted(before, mutant, function="f"))
        self.assertIn("if ((M0 ? (a >= kMost) : (a > kMost))) throw", inserted(after, mutant, function="f"))

    def lost(self, source, *pairs, function=""):
        with self.assertRaises(schemata.TableError) as error:
            inserted(source, *pairs, function=function)
        return str(error.exception)

    def test_a_lost_place_is_told_with_the_nearest(self):
        source = "int f() {\n  g(1);\n  return a + 2.0 * bc;\n}\nint h() { return a + 2.0 * b; }"
        self.assertIn("layer/m0: lost its place in f() of file", self.lost(source, ("a + 2.0 * b", "a"), function="f"))
        self.assertIn("line 3: a + 2.0 * bc", self.lost(source, ("a + 2.0 * b", "a"), function="f"))
        self.assertIn("no function j() in file; the original stands in h()",
                      self.lost(source, ("a + 2.0 * b", "a"), function="j"))
        self.assertIn("no function ff() in file; nearest: f()", self.lost(source, ("x", "y"), function="ff"))
        twice = self.lost("x = a + b;\ny = a + b;", ("a + b", "a - b"))
        self.assertIn("2 times", twice)
        self.assertIn("line 2: a + b", twice)

    def test_all_that_are_lost_are_told(self):
        told = self.lost("x = a;", ("b", "c"), ("d", "e"))
        self.assertIn("layer/m0", told)
        self.assertIn("layer/m1", told)


unittest.main()
