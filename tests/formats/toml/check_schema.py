"""Checks TOML files against data/schema with python3-jsonschema.

check_schema.py SCHEMAS --examples FOLDER   every TOML below FOLDER has to be valid
check_schema.py SCHEMAS --cases FOLDER      FOLDER/{system,body}/{good,bad}/*.toml have to be accepted and refused
check_schema.py SCHEMAS --keywords DOCS     the schemas use only the keywords that Bough's own checker knows, and every
                                            key is in DOCS/{system,body}-toml.md
"""
import json
import pathlib
import re
import sys
import tomllib

import jsonschema

KEYWORDS = {"$schema", "$id", "$ref", "$defs", "title", "description", "default", "type", "enum", "pattern", "properties",
            "required", "additionalProperties", "items", "minItems", "maxItems", "minimum", "exclusiveMinimum", "oneOf",
            "anyOf", "allOf", "not", "dims"}


def load(folder, kind):
    schema = json.loads((folder / f"{kind}.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def find_kind(document):
    if "campaign" in document:
        return "campaign"
    if "source" in document:
        return "budget"
    return "body" if isinstance(document.get("body"), dict) else "system"


def insert_parameters(node, parameters):
    """Puts the numbers of [parameters] in the place of "$name", as Bough does before it looks at the schema."""
    if isinstance(node, dict):
        return {key: insert_parameters(value, parameters) for key, value in node.items()}
    if isinstance(node, list):
        return [insert_parameters(value, parameters) for value in node]
    if isinstance(node, str) and node.startswith("$"):
        return parameters.get(node[1:], node)
    return node


def check_examples(validators, folder):
    files = sorted(folder.rglob("*.toml"))
    faults = []
    for path in files:
        document = tomllib.loads(path.read_text())
        document = insert_parameters(document, document.get("parameters", {}))
        faults += [f"{path}: {e.json_path}: {e.message}" for e in validators[find_kind(document)].iter_errors(document)]
    print(f"{len(files)} files below {folder}")
    return faults if files else [f"no TOML file below {folder}"]


def check_cases(validators, folder):
    faults = []
    for path in sorted(folder.rglob("*.toml")):
        kind, verdict = path.parts[-3], path.parts[-2]
        errors = list(validators[kind].iter_errors(tomllib.loads(path.read_text())))
        if bool(errors) != (verdict == "bad"):
            faults.append(f"{path} should be {verdict}: {[e.message for e in errors]}\n{path.read_text()}")
    return faults


def check_keywords(node, inside_properties=False):
    faults = []
    if isinstance(node, dict):
        for key, value in node.items():
            if not inside_properties and key not in KEYWORDS:
                faults.append(f"keyword {key} is not known to Bough")
            if key not in ("default", "enum") and (inside_properties or key != "dims"):
                faults += check_keywords(value, not inside_properties and key in ("properties", "$defs"))
            if inside_properties and "description" not in value and "$ref" not in value and not key.endswith("_deg"):
                if key not in ("vector", "number_or_list", "node_id", "node"):
                    faults.append(f"{key} has no description")
    elif isinstance(node, list):
        for value in node:
            faults += check_keywords(value)
    return faults


def collect_keys(node):
    keys = []
    if isinstance(node, dict):
        for key, value in node.items():
            if key == "properties":
                keys += list(value)
            keys += collect_keys(value)
    return keys


def collect_choices(node, key=""):
    """(key, choices) of every enum."""
    found = []
    if isinstance(node, dict):
        if isinstance(node.get("enum"), list):
            found.append((key, tuple(map(str, node["enum"]))))
        for inner, value in node.items():
            found += collect_choices(value, key if inner in ("items", "oneOf", "anyOf") else inner)
    elif isinstance(node, list):
        found += [pair for value in node for pair in collect_choices(value, key)]
    return found


def check_rows(kind, schema, text):
    """A page's keys and choices are those of the schema."""
    faults, known, choices = [], set(collect_keys(schema)), collect_choices(schema)
    tables = "".join(re.findall(r"^\| key \| type \|.*\n((?:\|.*\n)+)", text, re.M))
    for keys, type_, last in re.findall(r"^\| (`[a-z_`, 0-9]+`) \| ([^|]+) \| [^|]* \| ([^|]*) \|$", tables, re.M):
        for key in re.findall(r"`([a-z_0-9]+)`", keys):
            if key not in known:
                faults.append(f"{kind}-toml.md promises the key {key}, which the schema refuses")
            listed = re.match(r"((?:`[^`]+` ?)+)\.", last)
            if type_ != "choice" or not listed:
                continue
            words = re.findall(r"`([^`]+)`", listed[1])
            if not any(name == key and set(of) == set(words) for name, of in choices):
                faults.append(f"{kind}-toml.md: {key}: no list of choices of the schema is {words}")
    return faults


def check_docs(validators, folder):
    faults = []
    for kind, validator in validators.items():
        text = (folder / f"{kind}-toml.md").read_text()
        faults += check_rows(kind, validator.schema, text)
        faults += [f"{kind}-toml.md does not have the key {k}" for k in collect_keys(validator.schema)
                   if f"`{k}`" not in text and f"{k} =" not in text and f"[{k}]" not in text and f".{k}]" not in text]
    return faults


def main():
    folder = pathlib.Path(sys.argv[1])
    validators = {kind: load(folder, kind) for kind in ("system", "body", "campaign")}
    if sys.argv[2] == "--examples":
        validators["budget"] = load(folder, "budget")
        faults = check_examples(validators, pathlib.Path(sys.argv[3]))
    elif sys.argv[2] == "--cases":
        faults = check_cases(validators, pathlib.Path(sys.argv[3]))
    else:
        faults = sum((check_keywords(v.schema) for v in validators.values()), [])
        faults += check_docs(validators, pathlib.Path(sys.argv[3]))
    print("\n".join(faults))
    sys.exit(1 if faults else 0)


main()
