// A parameter of a node, as the graph file gave it.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lightnet {

struct Value;
using List = std::vector<Value>;

/// A Lua table: entries by position, entries by name.
struct Table {
    List list;
    std::map<std::string, Value> named;
    friend bool operator==(const Table&, const Table&);
};

/// Refers to another node by name.
struct NodeRef {
    std::string name;
    friend bool operator==(const NodeRef&, const NodeRef&) = default;
};

/// Numbers are doubles, as Lua's integers up to 2⁵³ fit one.
struct Value {
    std::variant<bool, double, std::string, NodeRef, Table> data;
    friend bool operator==(const Value&, const Value&) = default;
};

inline bool operator==(const Table& a, const Table& b) { return a.list == b.list && a.named == b.named; }

/// As few digits as tell the number from all others; integers without a point or an exponent.
std::string number_text(double number);
/// As one would write it in a graph file, for messages.
std::string to_string(const Value& value);
/// "a number", "a text" …, for messages.
std::string_view type_name(const Value& value);

}  // namespace lightnet
