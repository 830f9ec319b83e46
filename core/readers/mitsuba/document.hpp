// The XML of a Mitsuba scene: elements with their lines, after defaults, variables, includes and aliases.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/readers/common/assets.hpp"

namespace lightnet::mitsuba {

/// One element. Spellings of all versions of Mitsuba are those of version 3 here: "toWorld" is "to_world".
struct Node {
    std::string tag;   // "shape", "float"
    std::string type;  // of objects: "sphere"
    std::string name;  // of properties, in snake_case
    std::string id;
    std::map<std::string, std::string, std::less<>> attributes;  // the others, variables filled in
    std::vector<std::unique_ptr<Node>> children;
    SourceLine where;

    /// The value of an attribute; "": there is none.
    std::string_view attribute(std::string_view key) const;
    bool has(std::string_view key) const { return attributes.contains(key); }
};

struct Document {
    Node scene;
    std::map<std::string, const Node*, std::less<>> ids;
    std::set<std::string, std::less<>> lent;  // ids that a <ref> names
    std::vector<std::string> folders;         // further ones in which files may be
    int version = 0;                          // of Mitsuba, the first number of it; 0: the file says none
};

/// The path of a file that an element in the file `from` names: beside that file, beside the scene's first one, or in
/// one of its folders, whatever is there. As if beside `from`, where none is.
std::string path_of(Assets& assets, const Document& document, const std::string& from, const std::string& name);

/// "toWorld" → "to_world", "intIOR" → "int_ior".
std::string snake_case(std::string_view name);

/// Reads the file at `path` and all that it includes; `definitions` fill in variables. What is wrong is reported.
std::unique_ptr<Document> read_document(Assets& assets, const std::string& path,
                                        const std::map<std::string, std::string>& definitions);

}  // namespace lightnet::mitsuba
