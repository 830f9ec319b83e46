#include "core/base/json_tree.hpp"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "core/base/json.hpp"

namespace lightnet {

struct JsonMember {
    std::string name;
    JsonTree value;
};

namespace {

template <class... Cases>
struct ByKind : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
ByKind(Cases...) -> ByKind<Cases...>;  // which clang 14 doesn't find by itself

}  // namespace

JsonTree::JsonTree(std::nullptr_t) {}
JsonTree::JsonTree(Plain value) {
    std::visit([&](auto plain) { data_ = plain; }, value);
}
JsonTree::JsonTree(const char* text) : data_(std::string(text)) {}
JsonTree::JsonTree(std::string_view text) : data_(std::string(text)) {}
JsonTree::JsonTree(std::string text) : data_(std::move(text)) {}
JsonTree::JsonTree(const JsonTree& other) = default;
JsonTree::JsonTree(JsonTree&& other) noexcept = default;
JsonTree& JsonTree::operator=(const JsonTree& other) = default;
JsonTree& JsonTree::operator=(JsonTree&& other) noexcept = default;
JsonTree::~JsonTree() = default;

JsonTree::JsonTree(std::initializer_list<JsonTree> parts) {
    const bool named = std::all_of(parts.begin(), parts.end(), [](const JsonTree& part) { return part.is_pair(); });
    if (!named) {
        auto& entries = data_.emplace<List>();
        entries.reserve(parts.size());
        for (const auto& part : parts) entries.emplace_back().data_ = std::move(part.data_);
        return;
    }
    auto& members = data_.emplace<Object>();
    members.reserve(parts.size());
    for (const auto& part : parts) {
        auto& pair = std::get<List>(part.data_);
        members.push_back({std::move(std::get<std::string>(pair[0].data_)), std::move(pair[1])});
    }
}

JsonTree::JsonTree(const Json& json) {
    std::visit(ByKind{[&](std::monostate) {},
                      [&](const Json::List& entries) {
                          data_.emplace<List>();
                          for (const auto& entry : entries) push_back(JsonTree(entry));
                      },
                      [&](const Json::Object& members) {
                          data_.emplace<Object>();
                          for (const auto& [name, value] : members) add(name, JsonTree(value));
                      },
                      [&](const auto& value) { data_ = value; }},
               json.data);
}

bool JsonTree::is_pair() const {
    const auto* entries = std::get_if<List>(&data_);
    return entries && entries->size() == 2 && std::holds_alternative<std::string>(entries->front().data_);
}

JsonTree JsonTree::list() {
    JsonTree tree;
    tree.data_.emplace<List>();
    return tree;
}

JsonTree JsonTree::object() {
    JsonTree tree;
    tree.data_.emplace<Object>();
    return tree;
}

JsonTree& JsonTree::push_back(JsonTree entry) {
    if (std::holds_alternative<std::monostate>(data_)) data_.emplace<List>();
    return std::get<List>(data_).emplace_back(std::move(entry));
}

JsonTree& JsonTree::operator[](std::string_view name) {
    if (std::holds_alternative<std::monostate>(data_)) data_.emplace<Object>();
    auto& members = std::get<Object>(data_);
    const auto found =
        std::find_if(members.begin(), members.end(), [&](const JsonMember& one) { return one.name == name; });
    if (found != members.end()) return found->value;
    members.push_back({std::string(name), {}});
    return members.back().value;
}

void JsonTree::add(const std::string& name, JsonTree value) {
    std::get<Object>(data_).push_back({name, std::move(value)});
}

void JsonTree::change_texts(std::string (*change)(const std::string&)) {
    if (auto* text = std::get_if<std::string>(&data_)) *text = change(*text);
    if (auto* entries = std::get_if<List>(&data_))
        for (auto& entry : *entries) entry.change_texts(change);
    if (auto* members = std::get_if<Object>(&data_))
        for (auto& member : *members) member.value.change_texts(change);
}

/// Writes a tree; how texts and numbers are written, the library knows.
class JsonWriter {
public:
    explicit JsonWriter(const JsonStyle& style) : style_(style) {}

    void write(const JsonTree& tree, int depth) {
        std::visit(
            ByKind{[&](std::monostate) { text_ += "null"; }, [&](bool flag) { text_ += flag ? "true" : "false"; },
                   [&](const JsonTree::List& entries) { write(entries, depth); },
                   [&](const JsonTree::Object& members) { write(members, depth); },
                   [&](double number) { text_ += nlohmann::json(number).dump(); },
                   [&](const std::string& text) { write(text); }, [&](auto whole) { text_ += std::to_string(whole); }},
            tree.data_);
    }
    std::string text() && { return std::move(text_); }

private:
    using Tree = nlohmann::json;

    void write(const std::string& text) try {
        text_ += Tree(text).dump(-1, ' ', style_.ascii,
                                 style_.strict ? Tree::error_handler_t::strict : Tree::error_handler_t::replace);
    } catch (const Tree::exception&) {
        throw Error("a name in it is not UTF-8");
    }
    void write(const JsonTree::List& entries, int depth) {
        text_ += '[';
        for (const auto& entry : entries) {
            begin(&entry == &entries.front(), depth + 1);
            write(entry, depth + 1);
        }
        end(entries.empty(), depth, ']');
    }
    void write(const JsonTree::Object& members, int depth) {
        std::vector<const JsonMember*> order(members.size());
        std::transform(members.begin(), members.end(), order.begin(), [](const JsonMember& one) { return &one; });
        if (style_.by_name)
            std::sort(order.begin(), order.end(), [](const auto* a, const auto* b) { return a->name < b->name; });
        text_ += '{';
        for (const auto* member : order) {
            begin(member == order.front(), depth + 1);
            write(member->name);
            text_ += style_.indent < 0 ? ":" : ": ";
            write(member->value, depth + 1);
        }
        end(members.empty(), depth, '}');
    }
    void begin(bool first, int depth) {
        if (!first) text_ += ',';
        new_line(depth);
    }
    void end(bool empty, int depth, char bracket) {
        if (!empty) new_line(depth);
        text_ += bracket;
    }
    void new_line(int depth) {
        if (style_.indent < 0) return;
        text_ += '\n';
        text_.append(static_cast<std::size_t>(depth * style_.indent), ' ');
    }

    const JsonStyle& style_;
    std::string text_;
};

std::string to_text(const JsonTree& tree, const JsonStyle& style) {
    JsonWriter writer(style);
    writer.write(tree, 0);
    return std::move(writer).text();
}

std::string sorted_text(const JsonTree& tree) { return to_text(tree, {.by_name = true}); }

}  // namespace lightnet
