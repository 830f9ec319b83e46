// Mitsuba's participating media.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "core/readers/mitsuba/properties.hpp"

namespace lightnet::mitsuba {

/// The media of one scene, each made when it is asked for first.
class Media {
public:
    explicit Media(const Context& context) : context_(context) {}

    /// What a shape says of the media on its sides; none: nothing.
    std::optional<MediumSides> sides(Properties& shape);
    /// The medium that the property `name` names; none: it isn't given.
    std::optional<std::uint16_t> named(Properties& properties, std::string_view name);
    /// That of a <medium>.
    std::uint16_t made(const Node& node);

private:
    Medium medium(Properties& properties);
    void take(Properties& properties, std::string_view name, Rgb fallback, VolumeField& field);
    VolumeField volume(const Node& node);
    void place(Properties& properties, const Matrix& own, VolumeField& field);
    VolumeField grid(Properties& properties);
    PhaseFunction phase(const Node& node);

    const Context& context_;
    std::map<const Node*, std::uint16_t> made_;
};

}  // namespace lightnet::mitsuba
