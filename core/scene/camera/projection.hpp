// All projections there are, and what every one of them must be able to say.
#pragma once

#include <concepts>
#include <variant>

#include "core/scene/camera/flat_projections.hpp"
#include "core/scene/camera/panoramas.hpp"

namespace lightnet {

/// The list. What else there is to say of a projection stands where it is used, as overloads without a catch-all.
using AnyProjection = std::variant<Perspective, Orthographic, LatitudeLongitude, EqualArea>;

/// What every projection of the list is: a name, whether its camera may have a lens, and how it sees.
template <class P>
concept IsProjection = IsView<typename P::View> && requires {
    { P::name } -> std::convertible_to<const char*>;
    { P::has_lens } -> std::convertible_to<bool>;
};

template <class Projections>
struct ViewOf;
template <class... Projections>
struct ViewOf<std::variant<Projections...>> {
    static_assert((IsProjection<Projections> && ...), "a projection must say what IsProjection asks");
    using type = std::variant<typename Projections::View...>;
};
using AnyView = ViewOf<AnyProjection>::type;

}  // namespace lightnet
