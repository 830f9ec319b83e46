// Properties of an element of a Mitsuba scene, asked for by name and type.
#pragma once

#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/readers/mitsuba/document.hpp"

namespace lightnet::mitsuba {

/// What the makers of a scene's parts work with.
struct Context {
    Assets& assets;
    const Document& document;
    std::optional<double> seconds{};  // the moment that is wanted of what moves; none: its beginning

    Report& report() const { return assets.report(); }
    void error(const Node& node, std::string what) const { report().error(node.where, std::move(what)); }
    void warn(const Node& node, const std::string& what) const { report().warn(node.where, what); }
    /// What a <ref> means, or the node itself. Null: reported.
    const Node* resolved(const Node& node) const;
    /// The path of a file that is named in a node.
    std::string path(const std::string& name, const Node& node) const;
};

/// Of ASCII.
std::string lower_case(std::string_view text);
/// Numbers with spaces or commas between them. None: reported.
std::optional<std::vector<double>> numbers(std::string_view text, const Node& node, const Context& context);
/// A number, or the word of a fallback. None: reported.
std::optional<double> number(std::string_view text, const Node& node, const Context& context);
/// From attributes x, y and z, or from 'value'; what is missing is `missing`.
std::optional<Vec3> triple(const Node& node, const Context& context, float missing);

/// The properties of one object. Those that nobody asks for are named in a warning in the end.
class Properties {
public:
    Properties(const Node& node, const Context& context) : node_(node), context_(context) {}
    Properties(const Properties&) = delete;
    ~Properties();

    /// The property of that name, whatever its kind; null: not given.
    const Node* find(std::string_view name);
    bool has(std::string_view name) { return find(name) != nullptr; }
    float number(std::string_view name, float fallback);
    int integer(std::string_view name, int fallback);
    bool boolean(std::string_view name, bool fallback);
    std::string text(std::string_view name, const std::string& fallback);
    Vec3 point(std::string_view name, Vec3 fallback);
    /// Nested objects with that tag, references followed.
    std::vector<const Node*> objects(std::string_view tag);
    void ignore(std::initializer_list<std::string_view> names);
    void ignore_all() { all_ = true; }

    const Node& node() const { return node_; }
    const Context& context() const { return context_; }
    /// "bsdf 'diffuse'"
    std::string owner() const;

private:
    const Node& node_;
    const Context& context_;
    std::set<const Node*> asked_;
    bool all_ = false;
};

}  // namespace lightnet::mitsuba
