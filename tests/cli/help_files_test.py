"""The manual page and the completion for bash say what --help says: every command, option and example."""
import os
import re
import shutil
import subprocess
import unittest

from support import SOURCE, VERBS, ProgramTest


def list_options(help_text):
    """The options of a --help text, each as its names: [["-o", "--output"], ["--force"], ...]."""
    return [names.split(",") for names in re.findall(r"(?m)^  (-{1,2}\w[\w-]*(?:,--\w[\w-]*)*)(?=\s|$)", help_text)]


class HelpFiles(ProgramTest):
    def get_helps(self):
        return {verb: self.bough(*([verb] if verb else []), "--help").stdout for verb in ["", *VERBS]}

    def complete(self, *words):
        """Completions of bash with the cursor at the end of the last word."""
        self.write("completion.bash", self.bough("--bash-completion").stdout)
        script = ('source completion.bash; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); '
                  '$(complete -p bough | sed "s/.*-F \\([^ ]*\\).*/\\1/"); printf "%s\\n" "${COMPREPLY[@]}"')
        result = subprocess.run(["bash", "-c", script, "bash", "bough", *words], cwd=self.folder, text=True,
                                capture_output=True)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result.stdout.split()

    def test_the_help_names_options(self):
        helps = self.get_helps()
        for verb, text in helps.items():
            names = [name for option in list_options(text) for name in option]
            self.assertIn("--help", names, verb)
            self.assertEqual(len(names), len(set(names)))
        self.assertIn(["-o", "--output"], list_options(helps["reduce"]))
        self.assertIn(["--to"], list_options(helps["export"]))

    def test_man_page_has_every_verb_option_and_example(self):
        page = re.sub(r"\\f[BIR]", "", self.bough("--man-page").stdout).replace(r"\-", "-").replace(r"\&", "")
        page = page.replace(r"\e", "\\")
        sections = {"": page.split("\n.SH OPTIONS\n")[1].split("\n.SH COMMANDS\n")[0]}
        for part in page.split("\n.SH COMMANDS\n")[1].split(".SS bough ")[1:]:
            sections[part.split("\n")[0]] = part
        self.assertEqual(list(sections), ["", *VERBS])
        for verb, text in self.get_helps().items():
            entries = re.findall(r"(?m)^\.TP\n(-.*)\n(.+)", sections[verb])
            for names in list_options(text):
                with self.subTest(verb + " " + names[-1]):
                    found = [about for entry, about in entries if re.match(re.escape(", ".join(names)) + r"(\s|$)", entry)]
                    self.assertEqual(len(found), 1, entries)
                    self.assertIn(" ".join(found[0].split()), " ".join(text.split()))
            self.assertEqual(len(entries), len(list_options(text)))
            for example in re.findall(r"(?m)^  (bough \w.*)", text):
                self.assertIn(f"\n  {example}\n", sections[verb] if verb else page)

    def test_man_formats_the_page_without_a_word_of_warning(self):
        if not shutil.which("man") or not shutil.which("groff"):
            self.skipTest("no man and groff here")
        self.write("bough.1", self.bough("--man-page").stdout)
        result = subprocess.run(["man", "--warnings=w", "-l", "bough.1"], cwd=self.folder, text=True, capture_output=True,
                                env={"PATH": "/usr/bin:/bin", "MANWIDTH": "100", "LC_ALL": "C.UTF-8", "MANPAGER": "cat"})
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        for verb in VERBS:
            self.assertIn(f"bough {verb}", result.stdout)

    def test_completion_offers_every_verb_and_option(self):
        for verb, text in self.get_helps().items():
            with self.subTest(verb):
                names = [name for option in list_options(text) for name in option]
                self.assertEqual(sorted(self.complete(*([verb] if verb else []), "-")), sorted(names))
        self.assertEqual([word for word in self.complete("") if word[0] != "-"], VERBS)

    def test_completion_of_what_was_begun(self):
        self.assertEqual(self.complete("exp"), ["export"])
        self.assertEqual(self.complete("reduce", "boom.toml", "--out"), ["--output"])
        self.assertEqual(self.complete("export", "boom.h5", "--to", "mb"), ["mbdyn"])
        self.assertEqual(self.complete("export", "--to", "=", "v"), ["vtu"])
        self.assertIn("csv", self.complete("export", "--to", "="))
        self.assertEqual(self.complete("check", "boo"), [])  # file names: bash's own

    def test_each_verb_has_a_page_of_its_own(self):
        whole = self.bough("--man-page").stdout
        for verb in VERBS:
            with self.subTest(verb):
                page = self.bough(f"--man-page={verb}").stdout
                self.assertIn(f".SH NAME\nbough\\-{verb} \\- ", page)
                self.assertIn(f".BR bough\\-{verb} (1)", whole)
                entries = re.findall(r"(?m)^\.TP\n(.*)\n", page)
                section = whole.split(f".SS bough {verb}\n")[1].split(".SS ")[0].split(".SH ")[0]
                self.assertEqual(entries, re.findall(r"(?m)^\.TP\n(.*)\n", section))
        self.fails(2, "--man-page=nothing", says=["nothing"], error="cli.usage")

    def test_groups_of_help_are_in_completions_and_pages(self):
        groups = [(heading, re.findall(r"(?m)^  ([a-z]+) ", block)) for heading, block in re.findall(
            r"(?m)^(\S[^\n]*):\n((?:  [^\n]*\n)+)", self.bough("--help").stdout)]
        groups = [(heading, names) for heading, names in groups if names and set(names) <= set(VERBS)]
        self.assertEqual([name for _, names in groups for name in names], VERBS)
        bash, zsh, fish, man = (self.bough(f"--{kind}").stdout for kind in (
            "bash-completion", "zsh-completion", "fish-completion", "man-page"))
        with open(os.path.join(SOURCE, "README.md")) as f:
            readme = " ".join(f.read().split())
        with open(os.path.join(SOURCE, "docs/commands.md")) as f:
            commands = " ".join(f.read().split())
        for heading, names in groups:
            with self.subTest(heading):
                self.assertIn(f"# {heading}: {' '.join(names)}\n", bash)
                listed = re.search(rf"verbs=\(((?:\n *'[^\n]*)*)\n *\)\n *_describe -t commands-\d '{heading}' verbs\n", zsh)
                self.assertEqual(re.findall(r"(?m)^ *'([a-z]+):", listed.group(1)), names)
                self.assertEqual(re.findall(rf"-a ([a-z]+) -d '{heading}: ", fish), names)
                self.assertIn(f".PP\n{heading}:\n" + ",\n".join(names) + ".\n", man)
                self.assertIn(f"{heading}: {', '.join(names)}", readme)
                self.assertIn(f"* {heading}: " + ", ".join(f"[{name}](#{name})" for name in names), commands)

    def test_fish_offers_every_verb_and_option(self):
        if not shutil.which("fish"):
            self.skipTest("no fish here")
        self.write("bough.fish", self.bough("--fish-completion").stdout)

        def offer(line):
            result = subprocess.run(["fish", "--no-config", "-c", f"source bough.fish; complete -C '{line}'"], text=True,
                                    cwd=self.folder, capture_output=True, env={**os.environ, "HOME": self.folder})
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            return [row.split("\t")[0] for row in result.stdout.splitlines()]

        self.assertEqual(sorted(offer("bough ")), sorted(VERBS))
        self.assertEqual(offer("bough exp"), ["export"])
        self.assertEqual(offer("bough export --to mb"), ["mbdyn"])
        for verb, text in self.get_helps().items():
            with self.subTest(verb):
                names = [name for option in list_options(text) for name in option if name.startswith("--")]
                self.assertEqual(sorted(word for word in offer(f"bough {verb} --")), sorted(names))

    def test_zsh_reads_the_completion_and_it_names_every_option(self):
        script = self.bough("--zsh-completion").stdout
        self.write("_bough", script)
        if shutil.which("zsh"):
            self.assertEqual(subprocess.run(["zsh", "-n", self.path("_bough")], capture_output=True).stderr, b"")
        for verb, text in self.get_helps().items():
            line = re.search(rf"(?m)^    {verb}\) _arguments (.*)$", script) if verb else re.search(
                r"_arguments (.*)\n +else", script)
            with self.subTest(verb):
                names = [name for option in list_options(text) for name in option]
                self.assertEqual(sorted(re.findall(r"'\*(-{1,2}[\w-]+)=?\[", line.group(1))), sorted(names))


if __name__ == "__main__":
    unittest.main()
