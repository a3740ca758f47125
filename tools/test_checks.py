#!/usr/bin/env python3
"""Each check can fail: small trees, made for the purpose, with one fault each; and pass: the same without it.

SPDX-License-Identifier: MIT
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True

import check_core_alone
import check_headers
import check_includes
import check_links
import check_names
import check_spelling
import check_symbols
import check_text
import check_version
import command_pages
import format as layout
import header_pages
import make_metals
import make_model_pages
import make_site
import mutate

SPDX = "/* SPDX-License-Identifier: MIT */\n"


class CheckTest(unittest.TestCase):
    def setUp(self):
        self.root = tempfile.mkdtemp(prefix="facet-checks-")
        self.addCleanup(shutil.rmtree, self.root)

    def write(self, name, text):
        path = os.path.join(self.root, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text)
        return path

    def assert_one(self, problems, word):
        self.assertEqual(len(problems), 1, problems)
        self.assertIn(word, problems[0])


class Includes(CheckTest):
    def setUp(self):
        super().setUp()
        self.write("include/facet/facet.h", "#include <stddef.h>\n")
        self.write("core/error.h", '#include "facet/facet.h"\n')
        self.write("core/error.c", '#include "error.h"\n')
        self.write("render/film.c", '#include "core/error.h"\n#include <pthread.h>\n')
        self.write("io/exr.c", '#include "core/error.h"\n#include <OpenEXR/openexr.h>\n')
        self.write("tests/io/test_exr.c", '#include <cmocka.h>\n#include "core/error.h"\n')

    def test_clean_tree_passes(self):
        self.assertEqual(check_includes.check(self.root), [])

    def test_include_to_the_right(self):
        self.write("io/file.h", "")
        self.write("render/world.c", '#include "io/file.h"\n')
        self.assert_one(check_includes.check(self.root), "render/ may not include")

    def test_include_to_the_right_by_relative_path(self):
        self.write("render/film.h", "")
        self.write("core/bsdf.c", '#  include "../render/film.h"\n')
        self.assert_one(check_includes.check(self.root), "core/ may not include")

    def test_example_sees_internals(self):
        self.write("examples/hello.c", '#include "core/error.h"\n')
        self.assert_one(check_includes.check(self.root), "examples/ may not include")

    def test_library_in_two_files(self):
        self.write("io/image_file.c", "#include <openexr.h>\n")
        self.assert_one(check_includes.check(self.root), "OpenEXR is included by io/exr.c, io/image_file.c")

    def test_library_in_a_header(self):
        self.write("io/json.h", "#include <jansson.h>\n")
        self.assert_one(check_includes.check(self.root), "never by a header")

    def test_core_needs_posix(self):
        self.write("core/isa.c", "#include <pthread.h>\n")
        self.assert_one(check_includes.check(self.root), "C11 only")

    def test_product_needs_the_test_library(self):
        self.write("cli/main.c", "#include <cmocka.h>\n")
        self.assert_one(check_includes.check(self.root), "tests only")

    def test_unknown_library(self):
        self.write("cli/main.c", "#include <curl/curl.h>\n")
        self.assert_one(check_includes.check(self.root), "not known")

    def test_missing_file(self):
        self.write("cli/main.c", '#include "cli/nowhere.h"\n')
        self.assert_one(check_includes.check(self.root), "cli/main.c:1")

    def test_comment_is_no_include(self):
        self.write("core/note.c", '/*\n#include "io/file.h"\n*/\n')
        self.assertEqual(check_includes.check(self.root), [])


class Names(CheckTest):
    def test_pair_in_one_folder_passes(self):
        self.write("core/error.c", "")
        self.write("core/error.h", "")
        self.assertEqual(check_names.check(self.root), [])

    def test_same_name_in_two_folders(self):
        self.write("core/error.c", "")
        self.write("io/error.h", "")
        self.assert_one(check_names.check(self.root), "has this name already")

    def test_camel_case(self):
        self.write("render/imageFilm.c", "")
        self.assert_one(check_names.check(self.root), "snake_case")

    def test_hyphen(self):
        self.write("bench/two-words.c", "")
        self.assert_one(check_names.check(self.root), "snake_case")


class Text(CheckTest):
    def check_file(self, text, name="core/a.c"):
        self.write(name, text)
        return check_text.check(self.root)

    def test_clean_file_passes(self):
        self.assertEqual(self.check_file(SPDX + "int a; /* see https://example.org/home/x */\n"), [])

    def test_tab(self):
        self.assert_one(self.check_file(SPDX + "\tint a;\n"), "core/a.c:2: tab")

    def test_tab_in_makefile_passes(self):
        self.assertEqual(self.check_file("all:\n\ttrue\n", "Makefile"), [])

    def test_trailing_blank(self):
        self.assert_one(self.check_file("words \n", "docs/a.md"), "trailing blank")

    def test_carriage_return(self):
        self.write("docs/a.md", "")
        with open(os.path.join(self.root, "docs/a.md"), "wb") as stream:
            stream.write(b"words\r\n")
        self.assertIn("carriage return", check_text.check(self.root)[0])

    def test_no_final_newline(self):
        self.assert_one(self.check_file(SPDX + "int a;"), "no end")

    def test_machine_path(self):
        self.assert_one(self.check_file(SPDX + 'const char *a = "/ho' 'me/someone/a";\n'), "absolute path")

    def test_missing_licence(self):
        self.assert_one(self.check_file("int a;\n"), "SPDX")

    def test_doubled_licence(self):
        self.assert_one(self.check_file(SPDX + SPDX + "int a;\n"), "2 lines")

    def test_unfinished(self):
        self.assert_one(self.check_file(SPDX + "/* TO" "DO: more */\n"), "unfinished")

    def test_disabled(self):
        self.assert_one(self.check_file(SPDX + "#if 0\nint a;\n#endif\n"), "disabled")

    def test_long_line(self):
        self.assert_one(self.check_file(SPDX + "/*" + "x" * 120 + "*/\n"), "longer than")


class Links(CheckTest):
    def setUp(self):
        super().setUp()
        self.write("docs/models.md", "# Models\n\n## The GGX model: D, G1\n")

    def test_good_links_pass(self):
        self.write("README.md", "[m](docs/models.md#the-ggx-model-d-g1) [w](https://example.org) `[no](link)`\n")
        self.assertEqual(check_links.check(self.root), [])

    def test_missing_file(self):
        self.write("README.md", "see\n![picture](docs/none.png)\n")
        self.assert_one(check_links.check(self.root), "README.md:2: docs/none.png does not exist")

    def test_missing_heading(self):
        self.write("README.md", "[m](docs/models.md#beckmann)\n")
        self.assert_one(check_links.check(self.root), "no heading")

    def test_link_out_of_the_tree(self):
        self.write("docs/a.md", "[m](../../elsewhere.md)\n")
        self.assert_one(check_links.check(self.root), "leaves the tree")


@unittest.skipUnless(shutil.which("hunspell") and shutil.which("codespell"), "no hunspell or no codespell")
class Spelling(CheckTest):
    def setUp(self):
        super().setUp()
        self.write("tools/words.txt", "# of the project\nmicrofacet\n")

    def test_right_words_pass(self):
        self.write("README.md", "The colour of a Microfacet is what `facet_bdsf` says.\n\n    D(wm) = clr\n")
        self.assertEqual(check_spelling.check(self.root), [])

    def test_misspelt_word(self):
        self.write("docs/a.md", "# Words\n\n- it refelcts\n")
        self.assertIn("docs/a.md:3: refelcts", check_spelling.check(self.root)[0])

    def test_american_word(self):
        self.write("docs/a.md", "the color\n")
        self.assert_one(check_spelling.check(self.root), "color")

    def test_comment_of_a_header(self):
        self.write("include/facet/a.h", "/* Ret" "uns it. */\nint colr;\n")
        self.assertIn("Ret" "uns", check_spelling.check(self.root)[0])

    def test_slip_in_a_source(self):
        self.write("core/a.c", "/* it rec" "ieves */\n")
        self.assert_one(check_spelling.check(self.root), "core/a.c:1: rec" "ieves")

    def test_list_out_of_order(self):
        self.write("tools/words.txt", "texel\nmicrofacet\n")
        self.assert_one(check_spelling.check(self.root), "sorted")


class Site(CheckTest):
    def page(self, body):
        self.write("index.html", f"<html><body><h1 id=\"top\">A</h1>{body}</body></html>\n")
        return check_links.check_site(self.root)

    def test_good_links_pass(self):
        self.write("docs/a.html", "<a href=\"../index.html#top\">up</a>\n")
        self.assertEqual(self.page("<a href=\"docs/a.html\">a</a> <a href=\"https://example.org\">b</a>"), [])

    def test_missing_page(self):
        self.assert_one(self.page("<a href=\"docs/none.html\">a</a>"), "index.html:1: docs/none.html does not exist")

    def test_missing_anchor(self):
        self.assert_one(self.page("<a href=\"#bottom\">a</a>"), "no anchor #bottom")

    def test_missing_picture(self):
        self.assert_one(self.page("<img src=\"none.svg\">"), "none.svg does not exist")

    def test_loaded_from_elsewhere(self):
        self.assert_one(self.page("<script src=\"https://example.org/a.js\"></script>"), "loaded from elsewhere")

    def test_links_are_those_of_the_laid_out_documents(self):
        known = {"docs/README.md", "docs/a.md", "README.md"}
        text = "[a](a.md#b) [r](../README.md) [h](../include/facet/facet.h) [c](../core/x.c) `[no](x.c)` ![p](p.svg)"
        self.assertEqual(make_site.rewritten(text, "docs/README.md", known), (
            "[a](docs/a.md#b) [r](README.md) [h](api/facet.rst) [c](tree:core/x.c) `[no](x.c)` ![p](docs/p.svg)",
            {"docs/p.svg"}))

    def test_navigation_is_that_of_the_start_page(self):
        made = make_site.navigation("# A\n\n[x](x.md)\n\n## B\n\n- [Two words](docs/a.md): c\n")
        self.assertIn(":caption: B\n\nTwo words <docs/a>\n", made)
        self.assertNotIn("<x>", made)

    def test_theme_is_dark_where_the_browser_asks(self):
        dark = '@media not print {\n  body[data-theme="dark"] {\n    --color-background-primary: #111; }\n}\n'
        made = make_site.completed_style("@import url(/javascript/normalize.css/normalize.css);\n" + dark)
        self.assertNotIn("@import", made)
        self.assertIn("body { margin: 0; }", made)
        self.assertIn('body:not([data-theme="light"]) {\n    --color-background-primary: #111; }', made)
        self.assertEqual(made.count("{"), made.count("}"))
        self.assertEqual(make_site.completed_style(made), made)
        with self.assertRaisesRegex(ValueError, "no colours"):
            make_site.completed_style("body { margin: 0; }")

    def test_script_of_the_theme_is_whole(self):
        script = 'import Gumshoe from "./gumshoe-patched.js";\nmain();\n'
        self.assertEqual(make_site.completed_script(script, "part();"), "part();\nmain();\n")
        self.assertEqual(make_site.completed_script("main();\n", "part();"), "main();\n")

    def test_header_becomes_a_page(self):
        header = ("/* a.h: what it is, docs/b.md.\n * SPDX */\n#pragma once\n\n#define FACET_PLUGIN FACET_API\n\n"
                  "/* ---- Part ---- */\n\n/* Gives `n` of facet_b. */\n"
                  "FACET_API int facet_a(int n);\n\ntypedef struct facet_b {\n    int n; /* n */\n\n    int m;\n} facet_b;\n")
        made = header_pages.page("include/facet/a.h", [header], 0)
        for part in ("facet/a.h\n=========\n\nwhat it is, :doc:`docs/b.md </docs/b>`.", ".. c:macro:: FACET_PLUGIN",
                     "Part\n----", ".. c:function:: int facet_a(int n)",
                     "Gives ``n`` of", ":c:type:`facet_b`", ".. c:type:: facet_b", "    int m;"):
            self.assertIn(part, made)

    def test_commands_become_a_page(self):
        made = command_pages.page({"exit_status": "Exit status:\n  0    success\n", "commands": [{
            "name": "eval", "summary": "evaluate", "operands": "SPEC", "description": "It *is*\nfilled.\n  kept   so\n",
            "examples": "  facet eval ggx\n", "options": [{"name": "spp", "letter": "s", "value": "N", "help": "how `many`"}]}]})
        for part in ("facet eval\n----------", "    facet eval [OPTION]... SPEC", "It \\*is\\* filled.", "::\n\n      kept   so",
                     ".. option:: -s N, --spp N\n\n    how \\ ``many``", "    facet eval ggx", "    0    success"):
            self.assertIn(part, made)


class Headers(CheckTest):
    def test_good_headers_pass(self):
        self.write("include/facet/facet.h", "#pragma once\n#include <stddef.h>\nsize_t n(void);\n")
        self.write("core/kernel/k.h", "#pragma once\nstatic int k(void) { return (int[]){1}[0]; }\n")
        self.assertEqual(check_headers.check(self.root), [])

    def test_header_that_needs_another(self):
        self.write("io/a.h", "#pragma once\nvoid f(size_t n);\n")
        problems = check_headers.check(self.root)
        self.assertTrue(problems and all("io/a.h: does not compile alone" in p for p in problems), problems)

    @unittest.skipUnless(shutil.which(os.environ.get("CXX", "c++")), "no C++ compiler")
    def test_header_that_is_no_cxx(self):
        self.write("io/a.h", "#pragma once\nvoid f(int class);\n")
        self.assert_one(check_headers.check(self.root), "C++17")

    @unittest.skipUnless(shutil.which(os.environ.get("CXX", "c++")), "no C++ compiler")
    def test_public_header_that_needs_newer_cxx(self):
        self.write("include/facet/a.h", "#pragma once\nstruct a { int b; };\n"
                   "static inline struct a c(void) { struct a d = {.b = 1}; return d; }\n"
                   "static inline int e(void) { return c().b; }\n")
        self.assertTrue(any("C++17" in problem for problem in check_headers.check(self.root)))

    def test_header_without_guard(self):
        self.write("io/a.h", "void f(void);\n")
        self.assert_one(check_headers.check(self.root), "#pragma once")

    def test_kernel_that_fails_in_double_only(self):
        self.write("core/kernel/k.h", "#pragma once\n#if FACET_REAL_IS_DOUBLE\nint f(void) { return x; }\n#endif\n")
        self.assert_one(check_headers.check(self.root), "double")


class CoreAlone(CheckTest):
    PROGRAM = '#include "facet/facet.h"\nint main(void) { return facet(); }\n'

    def setUp(self):
        super().setUp()
        self.write("include/facet/facet.h", "int facet(void);\n")

    def test_plain_core_passes(self):
        self.write("core/facet.c", '#include "facet/facet.h"\nint facet(void) { return 0; }\n')
        self.assertEqual(check_core_alone.check(self.root, self.PROGRAM), [])

    def test_core_that_needs_the_root_as_include_folder(self):
        self.write("core/own.h", "")
        self.write("core/facet.c", '#include "core/own.h"\nint facet(void) { return 0; }\n')
        self.assertIn("own.h", check_core_alone.check(self.root, self.PROGRAM)[0])

    def test_core_that_misses_a_function(self):
        self.write("core/facet.c", "int other;\n")
        self.assertIn("undefined", check_core_alone.check(self.root, self.PROGRAM)[0])

    def test_core_that_computes_wrongly(self):
        self.write("core/facet.c", "int facet(void) { return 3; }\n")
        self.assertIn("status 3", check_core_alone.check(self.root, self.PROGRAM)[0])


class Symbols(CheckTest):
    def build(self, code):
        source, cc = self.write("a.c", code), os.environ.get("CC", "cc")
        self.write("include/facet/facet.h", "#define FACET_API\nFACET_API int *facet_one(int a);\n")
        files = [os.path.join(self.root, name) for name in ("a.o", "liba.so", "liba.a")]
        subprocess.run([cc, "-fPIC", "-c", source, "-o", files[0]], check=True)
        subprocess.run([cc, "-shared", files[0], "-o", files[1]], check=True)
        subprocess.run(["ar", "rcs", files[2], files[0]], check=True)
        return check_symbols.check(self.root, files[1], files[2])

    def test_prefixed_symbols_pass(self):
        self.assertEqual(self.build("static int own; int *facet_one(int a) { own = a; return &own; }"), [])

    def test_symbol_without_prefix(self):
        problems = self.build("int other; int *facet_one(int a) { other = a; return &other; }")
        self.assertEqual(len(problems), 2)  # the shared and the static library
        self.assertTrue(all("other" in problem for problem in problems))

    def test_hidden_symbol_without_prefix(self):
        self.assert_one(self.build("__attribute__((visibility(\"hidden\"))) int other; int *facet_one(int a) "
                                   "{ return &other + a; }"), "other is global")

    def test_declared_and_missing(self):
        self.assert_one(self.build("int facet_two;"), "facet_one is declared")


class Version(CheckTest):
    def setUp(self):
        super().setUp()
        self.write("CMakeLists.txt", "project(facet VERSION 1.2.3 LANGUAGES C)\n")
        self.header("1.2.3", 3)
        self.write("CHANGELOG.md", "# Changes\n\n## 1.2.3, 2030-01-31\n\n## 1.2.2, 2030-01-01\n")
        self.write("packaging/debian/changelog", "facet (1.2.3) unstable; urgency=medium\n")

    def header(self, comment, patch):
        self.write("include/facet/facet.h", "#define FACET_VERSION_MAJOR 1\n#define FACET_VERSION_MINOR 2\n"
                   f'#define FACET_VERSION_PATCH {patch}\n/* "{comment}"; static storage. */\n')

    def test_one_version_passes(self):
        self.assertEqual(check_version.check(self.root), [])

    def test_next_version_is_begun(self):
        self.write("CHANGELOG.md", "## 1.3.0, not released\n\n## 1.2.3, 2030-01-31\n")
        self.assertEqual(check_version.check(self.root), [])

    def test_old_package(self):
        self.write("packaging/debian/changelog", "facet (1.2.2) unstable; urgency=medium\n")
        self.assert_one(check_version.check(self.root), "packaging/debian/changelog: has version 1.2.2")

    def test_old_macros(self):
        self.header("1.2.3", 2)
        self.assert_one(check_version.check(self.root), "its macros say 1.2.2")

    def test_old_comment(self):
        self.header("1.2.2", 3)
        self.assert_one(check_version.check(self.root), "facet.h: has version 1.2.2")

    def test_release_that_the_changes_do_not_know(self):
        self.write("CHANGELOG.md", "## 1.2.2, 2030-01-01\n")
        self.assert_one(check_version.check(self.root), "the newest release is 1.2.2")

    def test_release_without_a_date(self):
        self.write("CHANGELOG.md", "## 1.2.3\n")
        self.assert_one(check_version.check(self.root), "no heading")

    def test_wrong_order(self):
        self.write("CHANGELOG.md", "## 1.2.3, 2030-01-31\n\n## 1.2.4, 2030-02-01\n")
        self.assert_one(check_version.check(self.root), "comes first")


class Layout(unittest.TestCase):
    def assert_tight(self, old, new):
        self.assertEqual(layout.tighten(old), new)

    def test_products_and_quotients(self):
        self.assert_tight("x = a * b + c / d - e % f;\n", "x = a*b + c/d - e%f;\n")

    def test_pointers_stay(self):
        text = "char *p = (char *)q + f(int (*)(void), **r);\n"
        self.assert_tight(text, text)

    def test_product_with_a_dereference(self):
        self.assert_tight("x = 2 * *p;\n", "x = 2**p;\n")

    def test_quotient_by_a_dereference_is_no_comment(self):
        self.assert_tight("x = a / *p;\n", "x = a / *p;\n")

    def test_comments_and_literals_stay(self):
        text = '/* a * b\n * c / d */ s = "a * b"; c = \' \'; // a / b\n'
        self.assert_tight(text, text)

    def test_frozen_region_stays(self):
        text = "/* clang-format off */\nx = a * b;\n/* clang-format on */\n"
        self.assert_tight(text + "x = a * b;\n", text + "x = a*b;\n")

    def test_continuation_moves_with_its_bracket(self):
        self.assert_tight("x = a * f(b,\n          c);\n", "x = a*f(b,\n        c);\n")

    def test_continuation_of_a_continuation(self):
        self.assert_tight("x = a * f(b * g(c,\n                d),\n          e);\n",
                          "x = a*f(b*g(c,\n            d),\n        e);\n")

    def test_backslashes_of_a_macro_stay_in_one_column(self):
        self.assert_tight("#define F(a)  \\\n    (a * a + \\\n     1)\n", "#define F(a)  \\\n    (a*a +   \\\n     1)\n")

    def test_next_statement_stays(self):
        text = "    for (i = 0; i < n; i++)\n        x = a;\n    y = b;\n"
        self.assert_tight(text, text)

    def test_trailing_comments_stay_in_one_column(self):
        self.assert_tight("x = a * b; /* one */\ny = c;     /* two,\n            * three */\nz;\n",
                          "x = a*b; /* one */\ny = c;   /* two,\n          * three */\nz;\n")


class Metals(CheckTest):
    def test_header_is_what_is_written(self):
        metals = make_metals.all_metals()
        text = make_metals.header_text(metals)
        check = lambda written: make_metals.check(pathlib.Path(self.write("metals.h", written)), metals)
        self.assertEqual(check(text), [])
        self.assertEqual(check(text.replace(" */", "\n   */")), [])
        self.assert_one(check(text.replace("4.47323", "4.47324")), "metals.h")

    def test_gold_is_held_in_gamut(self):
        gold = next(metal for metal in make_metals.all_metals() if metal.name == "Au")
        self.assertGreater(gold.F0[0], 1)
        self.assertEqual(gold.held[0], make_metals.HIGHEST)
        self.assertEqual(gold.held[1:], gold.F0[1:])


class ModelPages(CheckTest):
    MODEL = {"name": "matt", "parameters": [
        {"name": "kd", "kind": "colour", "low": 0, "high": 1, "default": [0.8, 0.8, 0.8], "unit": "1",
         "description": "reflectance"},
        {"name": "side", "kind": "choice", "default": "front", "choices": ["front", "back"], "description": "a|b"}]}
    PICTURE = "docs/images/models/matt.svg"

    def setUp(self):
        super().setUp()
        self.write(self.PICTURE, "<svg/>\n")
        self.page = make_model_pages.with_table(
            "# matt\n\n![a level line](../images/models/matt.svg)\n\n" + make_model_pages.BEGIN + make_model_pages.END,
            self.MODEL["parameters"])

    def problems(self, page):
        self.write("docs/models/matt.md", page)
        return make_model_pages.check(self.root, [self.MODEL])

    def test_written_page_passes(self):
        self.assertEqual(self.problems(self.page), [])
        self.assertIn("| kd | 0 to 1, colour | 0.8 | 1 | reflectance |\n", self.page)
        self.assertIn("| side | front, back | front |  | a\\|b |\n", self.page)

    def test_model_without_page(self):
        self.assert_one(make_model_pages.check(self.root, [self.MODEL]), "no page")

    def test_old_table(self):
        self.assert_one(self.problems(self.page.replace("0.8", "0.7")), "is not the program's")

    def test_page_without_marks(self):
        self.assert_one(self.problems(self.page.replace(make_model_pages.END, "")), "no marks")

    def test_picture_without_words(self):
        self.assert_one(self.problems(self.page.replace("a level line", "")), "does not show")

    def test_missing_picture(self):
        os.remove(os.path.join(self.root, self.PICTURE))
        self.assert_one(self.problems(self.page), "is missing")

    def test_large_picture(self):
        self.write(self.PICTURE, " "*(make_model_pages.BYTES + 1))
        self.assert_one(self.problems(self.page), "bytes")

    def test_thinned_line_stays_within_its_tolerance(self):
        points = [(x, 0.1*(x % 2) + (5 if x == 7 else 0)) for x in range(20)]
        kept = make_model_pages.thinned(points, 0.2)
        self.assertIn(points[7], kept)
        self.assertLess(len(kept), 8)


class Mutations(unittest.TestCase):
    def changed(self, code, kind, name="a.h"):
        return [code[:start] + new + code[end:] for k, start, end, new in mutate.mutations_of(name, code) if k == kind]

    def test_numbers(self):
        self.assertEqual(self.changed("x = 0.5f + c1;", "number"), ["x = 0.53125f + c1;"])
        self.assertEqual(self.changed("x = 1e-16;", "sign"), ["x = (-1e-16);"])
        self.assertEqual(self.changed("f(0, 0x3f80u);", "number"), ["f(1, 0x3f80u);", "f(0, 0x3f81u);"])
        self.assertEqual(self.changed("x = 2.0f;", "number", mutate.TABLES[0]), ["x = 2.0019999999999998f;"])

    def test_operators_with_two_operands_only(self):
        self.assertEqual(self.changed("x = -a + (real)-b; i++; p->q; x += 1e-5;", "operator"),
                         ["x = -a - (real)-b; i++; p->q; x += 1e-5;", "x = -a + (real)-b; i++; p->q; x -= 1e-5;"])
        self.assertEqual(self.changed("return -a;", "operator"), [])
        self.assertEqual(self.changed("x = a <= b | c << 1;", "operator"), ["x = a >= b | c << 1;"])
        self.assertEqual(self.changed("KERNEL real kmax(real a)\nx = kmin(a, 0);", "operator"),
                         ["KERNEL real kmax(real a)\nx = kmax(a, 0);"])

    def test_factors(self):
        self.assertEqual(self.changed("x = a*(b + c)*f(d).x*(real)0.5;", "factor"),
                         ["x = a*f(d).x*(real)0.5;", "x = a*(b + c)*(real)0.5;", "x = a*(b + c)*f(d).x;"])

    def test_arms(self):
        self.assertEqual(self.changed("x = f(a ? b : c, d);", "arms"), ["x = f(a ? c : b, d);"])
        self.assertEqual(self.changed("x = a ? (b ? c : d) : e;", "arms"),
                         ["x = a ? e : (b ? c : d);", "x = a ? (b ? d : c) : e;"])

    def test_code_only(self):
        text = '/* 1 + 2 */\n#if 3 > 2\n#include "a2*b.h"\n#define F(x) \\\n    (x*2)\n#endif\n'
        self.assertEqual(list(mutate.mutations_of("a.h", text)), [])
        self.assertEqual(self.changed("#define A (b*2) /* 3 */\n", "number"), ["#define A (b*3) /* 3 */\n"])


if __name__ == "__main__":
    unittest.main()
