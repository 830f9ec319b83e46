// Visits to the members of all that stands in a scene, without naming them again.
//
// Each type lists its members once, beside itself, in a function visit_members() that takes the type apart completely:
// a member that is missing there does not compile. What a list is shown to may be constant or not.
#pragma once

#include <concepts>
#include <optional>
#include <type_traits>
#include <variant>

#include "core/base/index_of.hpp"

namespace lightnet {

/// T, const or not.
template <class Any, class T>
concept Is = std::same_as<std::remove_const_t<Any>, T>;

template <class Element>
void visit_members(const IndexOf<Element>& index, const auto& visit) {
    visit(index.value);
}
template <class Element>
void visit_members(IndexOf<Element>& index, const auto& visit) {
    visit(index.value);
}

template <class Wanted, class T>
void visit_each(const std::optional<T>& value, const auto& visit);
template <class Wanted, class... T>
void visit_each(const std::variant<T...>& value, const auto& visit);

/// Shows `visit` each Wanted within a value: itself, its members, theirs, and so on. Not through lists. A type some of
/// whose members count only at times says which do by visit_used().
template <class Wanted, class T>
void visit_each(const T& value, const auto& visit) {
    const auto deeper = [&](const auto&... members) { (visit_each<Wanted>(members, visit), ...); };
    if constexpr (std::same_as<T, Wanted>)
        visit(value);
    else if constexpr (requires { visit_used(value, deeper); })
        visit_used(value, deeper);
    else if constexpr (requires { visit_members(value, deeper); })
        visit_members(value, deeper);
}
template <class Wanted, class T>
void visit_each(const std::optional<T>& value, const auto& visit) {
    if (value) visit_each<Wanted>(*value, visit);
}
template <class Wanted, class... T>
void visit_each(const std::variant<T...>& value, const auto& visit) {
    std::visit([&](const auto& one) { visit_each<Wanted>(one, visit); }, value);
}

}  // namespace lightnet
