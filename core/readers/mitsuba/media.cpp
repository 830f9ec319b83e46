#include "core/readers/mitsuba/media.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/suggestion.hpp"
#include "core/readers/common/inverse.hpp"
#include "core/readers/common/volume_file.hpp"
#include "core/readers/mitsuba/colours.hpp"
#include "core/readers/mitsuba/transforms.hpp"

namespace lightnet::mitsuba {
namespace {

const std::vector<std::string> known_media{"homogeneous", "heterogeneous"};
const std::vector<std::string> known_volumes{"constvolume", "gridvolume"};
const std::vector<std::string> known_phases{"isotropic", "hg", "rayleigh", "tabphase", "blendphase"};

// Of a box, to the unit cube.
Matrix to_unit(const Box& box) {
    Matrix result;
    const Vec3 size = box.size();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double along = size[axis] != 0 ? double(size[axis]) : 1.0;
        result.m[axis][axis] = 1 / along;
        result.m[axis][3] = -double(box.low[axis]) / along;
    }
    return result;
}

/// Of version 0.6, which takes a homogeneous medium without coefficients by a name.
void name_unknown(Properties& properties) {
    for (const char* name : {"sigma_t", "albedo", "sigma_a", "sigma_s"})
        if (properties.has(name)) return;
    properties.context().warn(properties.node(),
                              fmt::format("the coefficients of the medium '{}' are not known: a 'sigma_t' of 1 and an "
                                          "'albedo' of 0.75 are taken, which look otherwise",
                                          properties.text("material", "skin1").substr(0, 32)));
}

}  // namespace

std::optional<MediumSides> Media::sides(Properties& shape) {
    const auto inside = named(shape, "interior"), outside = named(shape, "exterior");
    if (!inside && !outside) return std::nullopt;
    return MediumSides{inside.value_or(Query::no_medium), outside.value_or(Query::no_medium)};
}

std::optional<std::uint16_t> Media::named(Properties& properties, std::string_view name) {
    const Node* given = properties.find(name);
    const Node* node = given ? context_.resolved(*given) : nullptr;
    if (!node) return std::nullopt;
    if (node->tag == "medium") return made(*node);
    context_.error(*given, fmt::format("'{}' of {} is no medium", name, properties.owner()));
    return std::nullopt;
}

std::uint16_t Media::made(const Node& node) {
    if (const auto known = made_.find(&node); known != made_.end()) return known->second;
    Properties properties(node, context_);
    Medium result = medium(properties);
    result.name = node.id;
    result.where = node.where;
    result.phase.normalise();
    if (const auto fault = result.fault(); !fault.empty()) context_.error(node, fault);
    auto& media = context_.assets.scene().media;
    media.push_back(std::move(result));
    return made_[&node] = static_cast<std::uint16_t>(std::min<std::size_t>(media.size() - 1, Query::no_medium));
}

Medium Media::medium(Properties& properties) {
    const Node& node = properties.node();
    Medium medium;
    if (context_.document.version == 0 && node.type == "homogeneous") name_unknown(properties);
    properties.ignore({"method", "step_size", "sample_emitters", "has_spectral_extinction", "majorant_grid_resolution",
                       "majorant_resolution_factor"});
    if (std::find(known_media.begin(), known_media.end(), node.type) == known_media.end()) {
        properties.ignore_all();
        context_.warn(node, fmt::format("medium '{}' is not supported{}: the space is taken as empty", node.type,
                                        did_you_mean(node.type, known_media)));
        return medium;
    }
    const bool by_parts = properties.has("sigma_a") || properties.has("sigma_s");
    if (by_parts) {  // as older versions of Mitsuba have it
        VolumeField absorbed;
        take(properties, "sigma_a", {}, absorbed);
        take(properties, "sigma_s", {}, medium.albedo);
        medium.albedo_scatters = true;
        if (absorbed.grid || medium.albedo.grid)
            context_.error(node, "'sigma_a' and 'sigma_s' can't be grids: give 'sigma_t' and 'albedo'");
        medium.extinction.value = absorbed.value + medium.albedo.value;
    } else {
        const bool older = properties.has("density");  // as version 0.6 has it
        take(properties, older ? "density" : "sigma_t", {1, 1, 1}, medium.extinction);
        take(properties, "albedo", {0.75f, 0.75f, 0.75f}, medium.albedo);
    }
    const float scale = properties.number("scale", 1);
    medium.extinction.value *= scale;
    if (by_parts) medium.albedo.value *= scale;
    take(properties, "emission", {}, medium.emission);
    for (const Node* phase_node : properties.objects("phase")) medium.phase = phase(*phase_node);
    return medium;
}

void Media::take(Properties& properties, std::string_view name, Rgb fallback, VolumeField& field) {
    const Node* given = properties.find(name);
    const Node* node = given ? context_.resolved(*given) : nullptr;
    if (!node)
        field.value = fallback;
    else if (node->tag == "volume")
        field = volume(*node);
    else if (is_colour(*node))
        field.value = surface_of(*node, context_).value_or(SurfaceColour{}).rgb;
    else
        context_.error(*given, fmt::format("'{}' of {} must be a colour or a volume", name, properties.owner()));
}

VolumeField Media::volume(const Node& node) {
    Properties properties(node, context_);
    if (node.type == "gridvolume") return grid(properties);
    if (node.type == "constvolume") {  // as Mitsuba has it, it fills its cube only, in version 0.6 all space
        VolumeField field{surface_of(properties, "value", {1, 1, 1}).rgb};
        if (context_.document.version == 0) return field;
        field.grid = std::make_shared<const VolumeGrid>(VolumeGrid{.values = {1}});
        place(properties, Matrix{}, field);
        return field;
    }
    properties.ignore_all();
    context_.error(node,
                   fmt::format("volume '{}' is not supported{}", node.type, did_you_mean(node.type, known_volumes)));
    return {};
}

/// Where the unit cube of a volume stands. `own`: from the volume's space to that cube.
void Media::place(Properties& properties, const Matrix& own, VolumeField& field) {
    const auto to_own = inverse(transform_of(properties));
    if (to_own)
        field.to_grid = own * *to_own;
    else
        context_.error(properties.node(), "the transform of a volume is singular");
}

VolumeField Media::grid(Properties& properties) {
    VolumeField field{{1, 1, 1}};
    const Node* name = properties.find("filename");
    VolumeGrid how;
    how.nearest = properties.text("filter_type", "trilinear") == "nearest";
    // version 0.6 has no unit cubes, but 'min' and 'max' of its own
    const bool older = context_.document.version == 0;
    const bool own_box = properties.boolean("use_grid_bbox", older);
    if (properties.text("wrap_mode", "clamp") != "clamp")
        context_.warn(properties.node(), "a volume does not repeat: 'clamp' is taken");
    properties.ignore({"raw", "max_value", "accel", "send_data"});
    if (!name) {
        context_.error(properties.node(), fmt::format("{} needs a 'filename'", properties.owner()));
        return field;
    }
    const auto path = context_.path(std::string(name->attribute("value")), *name);
    const auto bytes = context_.assets.read(path, name->where);
    if (!bytes) return field;
    try {
        const auto file = read_volume_file(**bytes, how);
        field.grid = file.grid;
        const Box box =
            older ? Box{properties.point("min", file.box.low), properties.point("max", file.box.high)} : file.box;
        place(properties, own_box ? to_unit(box) : Matrix{}, field);
    } catch (const Error& problem) {
        context_.report().error({path, 0}, problem.what());
    }
    return field;
}

PhaseFunction Media::phase(const Node& node) {
    Properties properties(node, context_);
    PhaseFunction phase;
    if (node.type == "isotropic") return phase;
    if (node.type == "hg") {
        phase.law = PhaseFunction::Law::henyey_greenstein;
        phase.g = properties.number("g", 0.8f);
    } else if (node.type == "rayleigh") {
        phase.law = PhaseFunction::Law::rayleigh;
    } else if (node.type == "tabphase") {
        phase.law = PhaseFunction::Law::tabulated;
        const auto values = numbers(properties.text("values", ""), node, context_);
        for (const double value : values.value_or(std::vector<double>{})) phase.table.push_back(float(value));
    } else if (node.type == "blendphase") {
        phase.law = PhaseFunction::Law::blend;
        const float weight = properties.number("weight", 0.5f);
        phase.table = {1 - weight, weight};
        for (const Node* part : properties.objects("phase")) phase.parts.push_back(this->phase(*part));
    } else {
        properties.ignore_all();
        context_.warn(node, fmt::format("phase function '{}' is not supported{}: 'isotropic' is taken", node.type,
                                        did_you_mean(node.type, known_phases)));
    }
    return phase;
}

}  // namespace lightnet::mitsuba
