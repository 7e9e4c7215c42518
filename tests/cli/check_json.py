#!/usr/bin/env python3
"""Checks results of `halfplane COMMAND --json` against a schema of docs/json.

  check_json.py [--described] SCHEMA RESULT...

--described: also refuses keys that the schema does not describe. Exit status 0: all are as the schema says; 1: not;
2: no such file, or a schema that is none.
"""
import argparse
import json
import pathlib
import sys

import jsonschema


def resolved(schema, folder, bundle):
    """The schema with what other files define put in its place: no version of jsonschema needs to look for them."""
    if isinstance(schema, list):
        return [resolved(item, folder, bundle) for item in schema]
    if not isinstance(schema, dict):
        return schema
    rest = {key: resolved(value, folder, bundle) for key, value in schema.items() if key != "$ref"}
    if "$ref" not in schema:
        return rest
    file, pointer = schema["$ref"].split("#")
    if file not in bundle:
        bundle[file] = json.loads((folder / file).read_text())
    target = bundle[file]
    for step in pointer.strip("/").split("/"):
        target = target[step]
    return {**resolved(target, folder, bundle), **rest}


def closed(schema):
    """The schema without leave to add keys."""
    if isinstance(schema, list):
        return [closed(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    result = {key: closed(value) for key, value in schema.items()}
    if result.get("additionalProperties") is True:
        result["additionalProperties"] = False
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--described", action="store_true", help="refuse keys that the schema does not describe")
    parser.add_argument("schema", type=pathlib.Path)
    parser.add_argument("results", type=pathlib.Path, nargs="+", metavar="result")
    options = parser.parse_args()
    schema = resolved(json.loads(options.schema.read_text()), options.schema.parent, {})
    if options.described:
        schema = closed(schema)
    try:
        jsonschema.Draft202012Validator.check_schema(schema)
    except jsonschema.SchemaError as error:
        print(f"{options.schema}: no schema: {error.message}")
        return 2
    validator = jsonschema.Draft202012Validator(schema)
    status = 0
    for path in options.results:
        for error in validator.iter_errors(json.loads(path.read_text())):
            place = "/".join(str(step) for step in error.absolute_path)
            print(f"{path}: {place or 'the result'}: {error.message[:300]}")
            status = 1
    return status


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, json.JSONDecodeError) as error:
        print(error)
        sys.exit(2)
