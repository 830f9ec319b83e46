// Whether JSON is as a schema in docs/schemas says.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tests/support/process.hpp"

namespace lightnet::test {

/// Is Python's package jsonschema here?
inline bool schemas_can_be_checked() {
    Process python({"/usr/bin/python3", "-c", "import jsonschema"});
    return python.wait() == 0;
}

/// What the schema docs/schemas/NAME.schema.json finds wrong with the JSON texts of a file, one in each line or one in
/// all; "": nothing.
inline std::string complaints_of_schema(const std::string& name, const std::filesystem::path& file,
                                        bool lines = false) {
    const std::string code =
        "import json, sys, jsonschema\n"
        "schema = json.load(open(sys.argv[1]))\n"
        "jsonschema.Draft202012Validator.check_schema(schema)\n"
        "check = jsonschema.Draft202012Validator(schema)\n"
        "text = open(sys.argv[2]).read()\n"
        "texts = text.splitlines() if sys.argv[3] == 'lines' else [text]\n"
        "for text in texts:\n"
        "    for wrong in check.iter_errors(json.loads(text)): print(wrong.json_path, wrong.message[:300])\n";
    Process python({"/usr/bin/python3", "-c", code,
                    std::string(LIGHTNET_SOURCE_DIR) + "/docs/schemas/" + name + ".schema.json", file.string(),
                    lines ? "lines" : "whole"});
    const int ended = python.wait();
    return ended == 0 ? python.output() : "python3 ended with " + std::to_string(ended) + ": " + python.output();
}

}  // namespace lightnet::test
