"""Files of continuous integration, pre-commit and containers hold what is there: they parse, each shell step is valid,
and every script, command of ./dev and .ci/run, hook and copied folder that they name exists.

ci.py SOURCE [BUILD]
"""
import os
import re
import subprocess
import sys

import yaml

# Commands of the images that the steps install or bring.
PROGRAMS = {"ls", "apt-get", "git", "cd", "export", "rm", "python3", "clang-format", "set", "echo"}


def read(source, path):
    with open(os.path.join(source, path), encoding="utf-8") as f:
        return f.read()


def list_cases(text):
    """Words of the cases of a shell script: "test | lint)"."""
    return {word.strip() for line in re.findall(r"^\s{2}([\w| -]+)\)", text, re.MULTILINE) for word in line.split("|")}


def check_script(source, text, where):
    """Faults of one shell step."""
    ran = subprocess.run(["bash", "-n"], input=text, text=True, capture_output=True)
    wrong = [f"{where}: error: {ran.stderr.strip()}"] if ran.returncode else []
    for line in re.split(r"\n|&&|\|\||;", text.replace("\\\n", " ")):
        words = [word for word in line.split() if not re.fullmatch(r"\w+=\S*", word)]
        if not words:
            continue
        program = words[0]
        if program.startswith(("./", ".ci/", "tools/", "tests/")):
            path = os.path.join(source, program)
            if not os.access(path, os.X_OK):
                wrong.append(f"{where}: error: {program} is not there, or is no program")
            elif len(words) > 1 and words[1][0] != "-" and words[1] not in list_cases(read(source, program)):
                wrong.append(f"{where}: error: {program} has no command {words[1]}")
        elif program not in PROGRAMS:
            wrong.append(f"{where}: error: {program} is no program that the images have")
        for word in words[1:]:
            if re.fullmatch(r"(tests|tools|docs)/[\w/.-]+\.py", word) and not os.path.isfile(os.path.join(source, word)):
                wrong.append(f"{where}: error: {word} is not there")
    return wrong


def check_workflow(source, path):
    flow = yaml.safe_load(read(source, path))
    wrong = []
    # YAML 1.1 reads the key `on` as true.
    for key in ("name", "jobs"):
        if key not in flow:
            wrong.append(f"{path}: error: no {key}")
    if not (flow.get("on") or flow.get(True)):
        wrong.append(f"{path}: error: nothing starts it")
    for name, job in flow.get("jobs", {}).items():
        if not job.get("steps") or not job.get("runs-on") or "timeout-minutes" not in job:
            wrong.append(f"{path}: error: job {name} needs runs-on, timeout-minutes and steps")
        matrix = job.get("strategy", {}).get("matrix", {})
        for used in re.findall(r"\$\{\{\s*matrix\.(\w+)", yaml.safe_dump(job)):
            if used not in matrix and not any(used in row for row in matrix.get("include", [])):
                wrong.append(f"{path}: error: job {name} has no matrix.{used}")
        for step in job.get("steps", []):
            if "run" in step:
                wrong += check_script(source, step["run"], f"{path}, step {step.get('name')}")
    return wrong


def check_hooks(source):
    path = ".pre-commit-config.yaml"
    wrong = []
    for repo in yaml.safe_load(read(source, path))["repos"]:
        for hook in repo["hooks"]:
            wrong += check_script(source, hook["entry"], f"{path}, hook {hook['id']}")
            try:
                re.compile(hook.get("files", ""))
            except re.error as error:
                wrong.append(f"{path}, hook {hook['id']}: error: {error}")
    return wrong


def check_container(source):
    wrong, stages = [], set()
    for line in read(source, "Containerfile").replace("\\\n", " ").split("\n"):
        word, _, rest = line.strip().partition(" ")
        where = f"Containerfile, {word}"
        if word == "RUN":
            rest, bound = re.sub(r"--mount=\S+", "", rest), re.search(r"--mount=\S*from=(\w+)", rest)
            if bound and bound.group(1) not in stages:
                wrong.append(f"{where}: error: no stage {bound.group(1)}")
            wrong += check_script(source, re.sub(r"[{}]", " ", rest), where)
        elif word == "FROM" and " AS " in rest:
            stages.add(rest.split(" AS ")[1])
        elif word == "COPY":
            found = re.match(r"--from=(\w+)", rest)
            if found and found.group(1) not in stages:
                wrong.append(f"{where}: error: no stage {found.group(1)}")
        elif word in ("ENTRYPOINT", "CMD"):
            if not isinstance(yaml.safe_load(rest), list):
                wrong.append(f"{where}: error: expected a list of words")
        elif word and word[0] != "#" and word not in ("ARG", "ENV", "WORKDIR", "FROM"):
            wrong.append(f"{where}: error: no such instruction here")
    # Options of ./dev package are looked up where it reads them.
    for option in re.findall(r"\./dev package (--[\w-]+)", read(source, "Containerfile")):
        if option not in read(source, "dev") and not any(
                option in read(source, os.path.join("packaging", name)) for name in os.listdir(
                    os.path.join(source, "packaging")) if os.path.isfile(os.path.join(source, "packaging", name))):
            wrong.append(f"Containerfile: error: ./dev package has no option {option}")
    return wrong


def main():
    source = sys.argv[1]
    folder = ".github/workflows"
    wrong = [fault for name in sorted(os.listdir(os.path.join(source, folder)))
             for fault in check_workflow(source, f"{folder}/{name}")]
    for name in os.listdir(os.path.join(source, ".github/ISSUE_TEMPLATE")):
        yaml.safe_load(read(source, f".github/ISSUE_TEMPLATE/{name}"))
    wrong += check_hooks(source) + check_container(source)
    wrong += [f".ci/run: error: ./dev has no command {word}" for word in
              re.findall(r"exec \./dev (\w+)", read(source, ".ci/run")) if word not in list_cases(read(source, "dev"))]
    print("\n".join(wrong) or "ci: 0 findings")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
