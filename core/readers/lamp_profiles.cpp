#include "core/readers/lamp_profiles.hpp"

#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "core/base/in_quotes.hpp"
#include "core/readers/common/light_profile.hpp"
#include "core/readers/common/turns.hpp"

namespace lightnet {
namespace {

/// `down`: of a light that shines alike in all directions. None: it is no luminaire.
std::optional<BareLight> shaped(const BareLight& light, const LightProfile& profile, const std::optional<Vec3>& down) {
    return std::visit(
        [&]<IsLight L>(const L& one) -> std::optional<BareLight> {
            if constexpr (IsLuminaire<L>) {
                const Matrix luminaire = down && one.aim() == Vec3{} ? hung(*down) : one.luminaire;
                L bright = one;
                return PointLight{one.position, bright.strength(), one.label, pattern_of(profile, luminaire),
                                  luminaire};
            }
            return std::nullopt;
        },
        light);
}

/// Also at later steps, where it moves.
bool shape(SceneData& scene, std::size_t which, const LightProfile& profile, const std::optional<Vec3>& down) {
    const auto made = shaped(scene.lights[which], profile, down);
    if (!made) return false;
    scene.lights[which] = *made;
    for (BareLight& step : SceneMotion::steps_after(scene.motion.lights, which))
        if (const auto then = shaped(step, profile, down)) step = *then;
    return true;
}

std::string name_of(const BareLight& light) {
    return std::visit([](const auto& one) { return one.name; }, light);
}

std::optional<LightProfile> profile_in(const std::string& path, Files& files, std::vector<Problem>& problems,
                                       const SourceLine& where) {
    try {
        const Bytes bytes = files.read(path);
        auto profile = read_light_profile({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
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
    for (const auto& [lamp, path] : profiles) {
        const auto profile = profile_in(path, files, problems, where);
        auto [lights, another, fault] = lamps_called(scene, lamp);
        if (!another.empty())
            fault = "lamp " + in_quotes(another) + " is no point and no spot, which alone can shine by a profile";
        if (profile && profile->tilted)
            scene.warnings.push_back({where, in_quotes(path) + ": how the lamp's light changes as it is tilted is left "
                                                               "out: it shines as where it hangs straight"});
        for (const std::size_t which : lights) {
            if (!done.insert(which).second)
                fault = "a lamp called " + in_quotes(lamp) + " has another profile already";
            else if (profile && !shape(scene, which, *profile, down))
                fault = "a lamp called " + in_quotes(lamp) + " is a " + name_of(scene.lights[which]) +
                        ": it has no profile";
        }
        if (!fault.empty()) problems.push_back({where, "'ies': " + fault});
    }
    if (!problems.empty()) throw UserError(std::move(problems));
}

}  // namespace lightnet
