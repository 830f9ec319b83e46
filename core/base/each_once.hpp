// Lists of types without repetition.
#pragma once

#include <concepts>
#include <type_traits>
#include <variant>

namespace lightnet {

template <class Found, class... More>
struct EachOnceOf {
    using type = Found;
};
template <class... Found, class Next, class... More>
struct EachOnceOf<std::variant<Found...>, Next, More...>
    : EachOnceOf<
          std::conditional_t<(std::same_as<Found, Next> || ...), std::variant<Found...>, std::variant<Found..., Next>>,
          More...> {};
template <class... Found, class... Next, class... More>
struct EachOnceOf<std::variant<Found...>, std::variant<Next...>, More...>
    : EachOnceOf<std::variant<Found...>, Next..., More...> {};

/// The variant of some types, each once and in their order; a variant among them stands for its own types.
template <class... Types>
using EachOnce = typename EachOnceOf<std::variant<>, Types...>::type;

}  // namespace lightnet
