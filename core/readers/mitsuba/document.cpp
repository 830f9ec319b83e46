#include "core/readers/mitsuba/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstring>
#include <pugixml.hpp>
#include <set>

#include "core/base/suggestion.hpp"

namespace lightnet::mitsuba {
namespace {

constexpr int deepest_element = 64, deepest_include = 16;
constexpr std::size_t most_includes = 1000, most_elements = 4'000'000;

/// Offsets in a text → lines.
class LineIndex {
public:
    explicit LineIndex(const std::vector<std::byte>& bytes) {
        for (std::size_t i = 0; i < bytes.size(); ++i)
            if (bytes[i] == std::byte{'\n'}) ends_.push_back(static_cast<std::ptrdiff_t>(i));
    }
    int line(std::ptrdiff_t offset) const {
        return 1 + static_cast<int>(std::lower_bound(ends_.begin(), ends_.end(), offset) - ends_.begin());
    }

private:
    std::vector<std::ptrdiff_t> ends_;
};

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// The tags of older versions.
std::string modern(std::string_view tag) {
    if (tag == "luminaire") return "emitter";
    if (tag == "camera") return "sensor";
    if (tag == "lookAt") return "lookat";
    return std::string(tag);
}

std::unique_ptr<Node> text_node(std::string name, std::string value, const SourceLine& where) {
    auto node = std::make_unique<Node>();
    node->tag = "string", node->name = std::move(name), node->where = where;
    node->attributes["value"] = std::move(value);
    return node;
}

/// What <luminaire> and <camera> of versions before 0.5 called otherwise.
void rename_parts(std::string_view tag, Node& object) {
    const bool luminaire = tag == "luminaire", camera = tag == "camera";
    if (!luminaire && !camera) return;
    const std::string& type = object.type;
    bool has_axis = false;
    for (auto& part : object.children) {
        std::string& name = part->name;
        if (luminaire && name == "intensity" && (type == "area" || type == "constant")) name = "radiance";
        if (luminaire && name == "intensity" && type == "directional") name = "irradiance";
        if (luminaire && name == "intensity_scale" && type == "envmap") name = "scale";
        has_axis |= name == "fov_axis" || name == "map_smaller_side";
        if (camera && name == "map_smaller_side") {
            const auto value = part->attribute("value");
            part = text_node("fov_axis", value == "false" ? "larger" : "smaller", part->where);
        }
    }
    if (camera && !has_axis) object.children.push_back(text_node("fov_axis", "smaller", object.where));
}

class Loader {
public:
    Loader(Assets& assets, const std::map<std::string, std::string>& definitions)
        : assets_(assets), variables_(definitions.begin(), definitions.end()), document_(new Document) {
        for (const auto& [name, value] : definitions) unused_.insert(name);
    }

    std::unique_ptr<Document> load(const std::string& path) {
        document_->scene.tag = "scene";
        document_->scene.where = {path, 0};
        file(path, {path, 0}, document_->scene);
        for (const auto& name : unused_)
            error({path, 0}, fmt::format("there is no variable '{}' to define{}", name, did_you_mean(name, declared_)));
        return std::move(document_);
    }

private:
    struct Source {
        std::string path;
        LineIndex lines;
    };

    void error(const SourceLine& where, std::string what) { assets_.report().error(where, std::move(what)); }

    void file(const std::string& path, const SourceLine& from, Node& into) {
        const auto bytes = assets_.read(path, from);
        if (!bytes) return;
        const Source source{path, LineIndex(**bytes)};
        pugi::xml_document xml;
        const auto result = xml.load_buffer((*bytes)->data(), (*bytes)->size());
        if (!result) {
            std::string what = result.description();
            if (!what.empty()) what[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(what[0])));
            return error({path, source.lines.line(result.offset)}, fmt::format("not sound XML: {}", what));
        }
        const auto root = xml.document_element();
        if (&into == &document_->scene && open_.empty()) document_->version = root.attribute("version").as_int();
        if (std::string_view(root.name()) == "scene")
            children(root, source, into, 1);
        else if (&into == &document_->scene && open_.empty())
            error({path, 1}, fmt::format("a Mitsuba scene begins with <scene>, not with <{}>",
                                         std::string(root.name()).substr(0, 32)));
        else
            element(root, source, into, 1);
    }

    void children(const pugi::xml_node& xml, const Source& source, Node& into, int depth) {
        for (const auto& child : xml.children())
            if (child.type() == pugi::node_element && !assets_.report().full() && !stop_)
                element(child, source, into, depth);
    }

    void element(const pugi::xml_node& xml, const Source& source, Node& into, int depth) {
        const SourceLine where{source.path, source.lines.line(xml.offset_debug())};
        if (depth > deepest_element) return error(where, "elements are nested too deeply");
        if (++elements_ > most_elements) {
            stop_ = true;
            return error(where, "there are too many elements");
        }
        const std::string_view tag = xml.name();
        if (tag == "default") return define(xml, where);
        if (tag == "include") return include(xml, where, into);
        if (tag == "alias") return alias(xml, where);
        if (tag == "path") return folder(filled(xml.attribute("value").value(), where), source.path);
        auto node = std::make_unique<Node>();
        node->tag = modern(tag);
        node->where = where;
        for (const auto& attribute : xml.attributes()) take(attribute, *node);
        children(xml, source, *node, depth + 1);
        rename_parts(tag, *node);
        if (node->tag == "ref") document_->lent.insert(node->id);
        remember(*node);
        into.children.push_back(std::move(node));
    }

    /// Beside the file that names it, and beside the scene's first one.
    void folder(const std::string& name, const std::string& from) {
        for (const auto& file : {from, document_->scene.where.file}) document_->folders.push_back(beside(file, name));
    }

    void take(const pugi::xml_attribute& attribute, Node& node) {
        const std::string_view key = attribute.name();
        std::string value = filled(attribute.value(), node.where);
        if (key == "name")
            node.name = snake_case(value);
        else if (key == "id")
            node.id = std::move(value);
        else if (key == "type")
            node.type = std::move(value);
        else
            node.attributes[std::string(key)] = std::move(value);
    }

    void remember(const Node& node) {
        static const std::set<std::string, std::less<>> objects{"shape",    "bsdf",  "texture", "emitter", "medium",
                                                                "sensor",   "film",  "sampler", "rfilter", "integrator",
                                                                "spectrum", "phase", "volume"};
        if (node.id.empty() || !objects.contains(node.tag)) return;
        if (!document_->ids.emplace(node.id, &node).second)
            error(node.where, fmt::format("there is another element with the id '{}'", node.id));
    }

    void define(const pugi::xml_node& xml, const SourceLine& where) {
        const std::string name = xml.attribute("name").value();
        variables_.emplace(name, filled(xml.attribute("value").value(), where));
        declared_.push_back(name);
        unused_.erase(name);
    }

    void alias(const pugi::xml_node& xml, const SourceLine& where) {
        const std::string id = filled(xml.attribute("id").value(), where);
        const auto known = document_->ids.find(id);
        if (known == document_->ids.end()) return error(where, fmt::format("there is no id '{}' above", id));
        document_->lent.insert(id);
        document_->ids.emplace(filled(xml.attribute("as").value(), where), known->second);
    }

    void include(const pugi::xml_node& xml, const SourceLine& where, Node& into) {
        const std::string name = filled(xml.attribute("filename").value(), where);
        const std::string path = path_of(assets_, *document_, where.file, name);
        if (open_.contains(path) || path == document_->scene.where.file)
            return error(where, fmt::format("'{}' includes itself", name));
        if (open_.size() >= deepest_include || ++includes_ > most_includes)
            return error(where, fmt::format("'{}': files include each other too deeply or too often", name));
        open_.insert(path);
        file(path, where, into);
        open_.erase(path);
    }

    /// With $variables filled in.
    std::string filled(std::string_view text, const SourceLine& where) {
        std::string result;
        for (auto at = text.find('$'); at != text.npos; at = text.find('$')) {
            result += text.substr(0, at);
            text.remove_prefix(at + 1);
            std::size_t end = 0;
            while (end < text.size() && is_name(text[end])) ++end;
            std::size_t used = end;  // the longest name that is known
            while (used > 0 && !variables_.contains(text.substr(0, used))) --used;
            if (used) {
                const auto& [name, value] = *variables_.find(text.substr(0, used));
                result += value;
                unused_.erase(name);
            } else {
                unknown(text.substr(0, end), where);
                used = end;
            }
            text.remove_prefix(used);
            if (result.size() > 1 << 20) return result;  // variables of variables
        }
        return result += text;
    }

    void unknown(std::string_view name, const SourceLine& where) {
        std::vector<std::string> known;
        for (const auto& [variable, value] : variables_) known.push_back(variable);
        error(where, fmt::format("there is no variable '${}'{}", name, did_you_mean(name, known)));
    }

    Assets& assets_;
    std::map<std::string, std::string, std::less<>> variables_;
    std::set<std::string> unused_;       // definitions from outside that nothing has asked for
    std::vector<std::string> declared_;  // variables that have defaults
    std::unique_ptr<Document> document_;
    std::set<std::string> open_;
    std::size_t elements_ = 0, includes_ = 0;
    bool stop_ = false;
};

}  // namespace

std::string_view Node::attribute(std::string_view key) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? std::string_view() : std::string_view(found->second);
}

std::string path_of(Assets& assets, const Document& document, const std::string& from, const std::string& name) {
    const std::string near = beside(from, name), main = beside(document.scene.where.file, name);
    for (const auto& path : {near, main})
        if (assets.exists(path)) return path;
    for (const auto& folder : document.folders)
        if (const auto path = beside(folder + "/", name); assets.exists(path)) return path;
    return near;
}

std::string snake_case(std::string_view name) {
    std::string result;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto c = static_cast<unsigned char>(name[i]);
        if (std::isupper(c) && i > 0 &&
            (std::islower(static_cast<unsigned char>(name[i - 1])) ||
             std::isdigit(static_cast<unsigned char>(name[i - 1]))))
            result += '_';
        result += static_cast<char>(std::tolower(c));
    }
    return result;
}

std::unique_ptr<Document> read_document(Assets& assets, const std::string& path,
                                        const std::map<std::string, std::string>& definitions) {
    return Loader(assets, definitions).load(path);
}

}  // namespace lightnet::mitsuba
