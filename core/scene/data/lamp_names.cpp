#include "core/scene/data/lamp_names.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/base/in_quotes.hpp"
#include "core/base/joined.hpp"
#include "core/base/lamp_groups.hpp"
#include "core/base/suggestion.hpp"

namespace lightnet {
namespace {

bool shines(const SceneData& scene, const Shape& shape) {
    return shape.emission && !is_black(shape.emission->radiance) && shape.material < scene.materials.size() &&
           !std::holds_alternative<NoMaterial>(scene.materials[shape.material].model);
}

/// Calls what has no name by what it is.
class Namer {
public:
    std::vector<std::string> names(std::vector<std::string> given, const std::string& what) {
        std::vector<std::string> found;
        for (auto& name : given)
            if (!name.empty() && std::find(found.begin(), found.end(), name) == found.end())
                found.push_back(std::move(name));
        if (!found.empty()) return found;
        const std::size_t number = ++counts_[what];
        return {what + (number > 1 ? std::to_string(number) : "")};
    }

private:
    std::map<std::string, std::size_t> counts_;
};

/// with(names, what, group) of each lamp; the group can be written.
template <class Scene, class With>
void each_lamp(Scene& scene, With&& with) {
    Namer namer;
    for (auto& shape : scene.shapes) {
        if (!shines(scene, shape)) continue;
        auto& label = shape.emission->label;
        with(namer.names({label.name, shape.name, scene.materials[shape.material].name}, "lamp"), "shape", label.group);
    }
    for (auto& light : scene.lights) {
        std::visit([&](auto& one) { with(namer.names({one.label.name}, one.name), one.name, one.label.group); }, light);
    }
    const auto bright = [](const EnvironmentData& one) { return !is_black(one.radiance); };
    if (std::any_of(scene.environments.begin(), scene.environments.end(), bright))
        with(std::vector<std::string>{"environment"}, "environment", scene.environment_group);
}

std::vector<std::string> all_names(const SceneData& scene) {
    std::set<std::string> names;
    each_lamp(scene, [&](const auto& own, const char*, std::uint32_t) { names.insert(own.begin(), own.end()); });
    return {names.begin(), names.end()};
}

// What there is, for a name that nothing has.
std::string hint(const std::string& wanted, std::vector<std::string> known) {
    if (known.empty()) return ": the scene has no lamps";
    if (auto guess = did_you_mean(wanted, known); !guess.empty()) return guess;
    constexpr std::size_t most = 40;
    const bool more = known.size() > most;
    if (more) known.resize(most);
    return " (there is: " + joined(known) + (more ? ", …" : "") + ")";
}

bool goes_by_any(const std::vector<std::string>& names, const std::string& wanted) {
    return std::any_of(names.begin(), names.end(), [&](const auto& name) { return goes_by(name, wanted); });
}

}  // namespace

bool goes_by(const std::string& name, const std::string& wanted) {
    return name == wanted || (!name.empty() && fnmatch(wanted.c_str(), name.c_str(), FNM_NOESCAPE) == 0);
}

std::vector<NamedLamp> lamps_of(const SceneData& scene) {
    std::vector<NamedLamp> lamps;
    std::map<std::pair<std::vector<std::string>, std::string>, std::size_t> known;
    each_lamp(scene, [&](const auto& names, const char* what, std::uint32_t group) {
        const auto [at, added] = known.try_emplace({names, what}, lamps.size());
        if (added)
            lamps.push_back({names, what, 1, group});
        else
            ++lamps[at->second].count;
    });
    return lamps;
}

std::vector<std::string> lamp_names_of_shapes(const SceneData& scene) {
    std::vector<std::string> names(scene.shapes.size());
    auto name = names.begin();
    each_lamp(scene, [&](const auto& own, const std::string& what, std::uint32_t) {
        if (what != "shape") return;
        while (!shines(scene, scene.shapes[std::size_t(name - names.begin())])) ++name;
        *name++ = own.front();
    });
    return names;
}

LampsCalled lamps_called(const SceneData& scene, const std::string& wanted) {
    LampsCalled found;
    std::size_t shape = 0, light = 0;
    each_lamp(scene, [&](const auto& names, const std::string& what, std::uint32_t) {
        const bool meant = goes_by_any(names, wanted), around = what == "environment",
                   bare = what != "shape" && !around;
        if (what == "shape")
            while (!shines(scene, scene.shapes[shape])) ++shape;
        if (meant && bare) found.lights.push_back(light);
        if (meant && what == "shape") found.shapes.push_back(shape);
        if (meant && !bare && found.another.empty()) found.another = names.front();
        found.around |= meant && around;
        light += bare, shape += what == "shape";
    });
    if (found.lights.empty() && found.another.empty())
        found.fault = "there is no lamp called " + in_quotes(wanted) + hint(wanted, all_names(scene));
    return found;
}

std::vector<std::string> sort_lamps(SceneData& scene, const std::vector<LampGroup>& groups) {
    scene.groups.clear();
    for (const auto& group : groups) scene.groups.push_back(group.name);
    scene.groups.emplace_back(rest_of_lamps);
    std::vector<std::string> wrong;
    std::set<std::pair<std::size_t, std::string>> met;  // group, and name in it
    std::set<std::string> told;
    each_lamp(scene, [&](const auto& names, const char*, std::uint32_t& place) {
        std::vector<std::size_t> in;
        for (std::size_t g = 0; g < groups.size(); ++g) {
            bool is_in = false;
            for (const auto& wanted : groups[g].lamps)
                if (goes_by_any(names, wanted)) met.emplace(g, wanted), is_in = true;
            if (is_in) in.push_back(g);
        }
        place = static_cast<std::uint32_t>(in.empty() ? groups.size() : in.front());
        if (in.size() > 1 && told.insert(names.front()).second)
            wrong.push_back("lamp " + in_quotes(names.front()) + " is in two groups, " + in_quotes(groups[in[0]].name) +
                            " and " + in_quotes(groups[in[1]].name));
    });
    for (std::size_t g = 0; g < groups.size(); ++g)
        for (const auto& wanted : groups[g].lamps)
            if (!met.contains({g, wanted}))
                wrong.push_back("group " + in_quotes(groups[g].name) + ": there is no lamp called " +
                                in_quotes(wanted) + hint(wanted, all_names(scene)));
    return wrong;
}

}  // namespace lightnet
