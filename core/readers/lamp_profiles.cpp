#include "core/readers/lamp_profiles.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/in_quotes.hpp"
#include "core/readers/common/light_profile.hpp"
#include "core/readers/common/turns.hpp"
#include "core/readers/files/other_places.hpp"

namespace lightnet {
namespace {

/// Down: of a light that shines alike in all directions. Up: of the world, by which lamps are tilted. None: unknown.
struct Hanging {
    std::optional<Vec3> down, up;
};

/// None: it is no luminaire.
std::optional<BareLight> shaped(const BareLight& light, const LightProfile& profile, const Hanging& hanging) {
    return std::visit(
        [&]<IsLight L>(const L& one) -> std::optional<BareLight> {
            if constexpr (IsLuminaire<L>) {
                const auto& [down, up] = hanging;
                const Matrix luminaire = down && one.aim() == Vec3{} ? hung(*down) : one.luminaire;
                L bright = one;
                const float factor = up ? profile.tilt.factor(luminaire, *up) : profile.tilt.straight();
                return PointLight{one.position, bright.strength() * factor, one.label, pattern_of(profile, luminaire),
                                  luminaire};
            }
            return std::nullopt;
        },
        light);
}

/// Also at later steps, where it moves.
bool shape(SceneData& scene, std::size_t which, const LightProfile& profile, const Hanging& hanging) {
    const auto made = shaped(scene.lights[which], profile, hanging);
    if (!made) return false;
    scene.lights[which] = *made;
    for (BareLight& step : SceneMotion::steps_after(scene.motion.lights, which))
        if (const auto then = shaped(step, profile, hanging)) step = *then;
    return true;
}

std::string name_of(const BareLight& light) {
    return std::visit([](const auto& one) { return one.name; }, light);
}

std::string_view text_of(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The file of factors that the profile at `path` names, or one of that name beside it.
std::optional<std::string> tilt_named(std::string name, const std::string& path, Files& files) {
    std::ranges::replace(name, '\\', '/');
    const std::string written = beside(path, name);
    try {
        return std::string(text_of(*files.read(written)));
    } catch (const MissingHere&) {
        throw;
    } catch (const Error&) {  // other machines call it otherwise
    }
    const auto others = other_places(files, path, written);
    return others.empty() ? std::nullopt : std::optional(std::string(text_of(*files.read(others[0]))));
}

std::optional<LightProfile> profile_in(const std::string& path, Files& files, std::vector<Problem>& problems,
                                       const SourceLine& where) {
    try {
        const Bytes bytes = files.read(path);
        const auto tilt = [&](const std::string& name) { return tilt_named(name, path, files); };
        auto profile = read_light_profile(text_of(*bytes), tilt);
        return profile;
    } catch (const MissingHere&) {
        throw;
    } catch (const Error& problem) {
        problems.push_back({where, "'ies': can't read " + in_quotes(path) + ": " + problem.what()});
        return std::nullopt;
    }
}

}  // namespace

void put_profiles(std::span<const ProfileOverride> profiles, const std::optional<Vec3>& down, SceneData& scene,
                  Files& files, const SourceLine& where) {
    std::vector<Problem> problems;
    std::set<std::size_t> done;
    const Hanging hanging{down, down ? std::optional(-*down) : scene.up};
    for (const auto& [lamp, path] : profiles) {
        const auto profile = profile_in(path, files, problems, where);
        auto [shapes, lights, around, another, fault] = lamps_called(scene, lamp);
        if (!another.empty())
            fault = "lamp " + in_quotes(another) + " is no point and no spot, which alone can shine by a profile";
        if (const std::string lacks = profile ? lacks_of_tilt(*profile, hanging.up.has_value()) : ""; !lacks.empty())
            scene.warnings.push_back({where, in_quotes(path) + ": " + lacks});
        for (const std::size_t which : lights) {
            if (!done.insert(which).second)
                fault = "a lamp called " + in_quotes(lamp) + " has another profile already";
            else if (profile && !shape(scene, which, *profile, hanging))
                fault = "a lamp called " + in_quotes(lamp) + " is a " + name_of(scene.lights[which]) +
                        ": it has no profile";
        }
        if (!fault.empty()) problems.push_back({where, "'ies': " + fault});
    }
    if (!problems.empty()) throw UserError(std::move(problems));
}

}  // namespace lightnet
