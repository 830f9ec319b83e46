#include "core/readers/mitsuba/attributes.hpp"

#include <algorithm>
#include <set>

namespace lightnet::mitsuba {
namespace {

void collect(const Node& node, const Context& context, std::set<const Node*>& seen, std::vector<std::string>& names) {
    if (!seen.insert(&node).second) return;
    if (node.tag == "texture" && node.type == "mesh_attribute")
        for (const auto& child : node.children)
            if (const std::string name(child->attribute("value")); child->name == "name")
                if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    for (const auto& child : node.children) {
        const auto known = child->tag == "ref" ? context.document.ids.find(child->id) : context.document.ids.end();
        collect(known == context.document.ids.end() ? *child : *known->second, context, seen, names);
    }
}

}  // namespace

std::vector<std::string> attributes_in(const Node& node, const Context& context) {
    std::set<const Node*> seen;
    std::vector<std::string> names;
    collect(node, context, seen, names);
    return names;
}

}  // namespace lightnet::mitsuba
