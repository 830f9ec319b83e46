#include "core/readers/gltf/animations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <set>
#include <span>
#include <string_view>
#include <system_error>

#include "core/base/in_quotes.hpp"
#include "core/base/joined.hpp"
#include "core/base/suggestion.hpp"
#include "core/readers/common/between_transforms.hpp"

namespace lightnet::gltf {
namespace {

using Numbers = std::vector<double>;

enum class Between { line, step, cubic };

std::optional<Between> between_of(const At& sampler) {
    const std::string word = sampler["interpolation"].text("LINEAR");
    if (word == "LINEAR") return Between::line;
    if (word == "STEP") return Between::step;
    if (word == "CUBICSPLINE") return Between::cubic;
    sampler["interpolation"].error("must be LINEAR, STEP or CUBICSPLINE");
    return std::nullopt;
}

/// glTF 2.0, appendix C.4.
Numbers turned(std::span<const float> a, std::span<const float> b, double t) {
    const Quaternion q = slerp({a[0], a[1], a[2], a[3]}, {b[0], b[1], b[2], b[3]}, t);
    return {q.begin(), q.end()};
}

/// The keys of a channel.
class Keys {
public:
    Keys(Values times, Values values, Between between)
        : times_(std::move(times.numbers)),
          values_(std::move(values.numbers)),
          between_(between),
          width_(values_.size() / (times_.size() * parts())) {}

    /// Something in its numbers does not fit; "": all does.
    static std::string fault(const Values& times, const Values& values, Between between) {
        const std::size_t parts = between == Between::cubic ? 3 : 1;
        if (times.width != 1 || times.numbers.empty()) return "has no keys";
        if (values.numbers.empty() || values.numbers.size() % (times.numbers.size() * parts) != 0)
            return "must have as many values as keys";
        if (std::ranges::adjacent_find(times.numbers, std::greater{}) != times.numbers.end())
            return "has keys that don't follow each other in time";
        return "";
    }
    bool jumps() const { return std::ranges::adjacent_find(times_) != times_.end(); }

    std::size_t width() const { return width_; }

    Numbers at(double seconds, bool turns) const {
        const auto behind = std::ranges::upper_bound(times_, seconds, {}, [](float time) { return double(time); });
        const auto next = static_cast<std::size_t>(behind - times_.begin());
        if (next == 0 || next == times_.size()) return copy(value(next ? next - 1 : 0));
        const std::size_t last = next - 1;
        if (between_ == Between::step) return copy(value(last));
        const double step = double(times_[next]) - double(times_[last]);
        const double t = (seconds - double(times_[last])) / step;
        if (between_ == Between::cubic) return cubic(last, t, step);
        if (turns && width_ == 4) return turned(value(last), value(next), t);
        Numbers mean(width_);
        for (std::size_t i = 0; i < width_; ++i)
            mean[i] = double(value(last)[i]) * (1 - t) + double(value(next)[i]) * t;
        return mean;
    }

private:
    std::size_t parts() const { return between_ == Between::cubic ? 3 : 1; }
    std::span<const float> part(std::size_t key, std::size_t which) const {
        return std::span(values_).subspan((key * parts() + which) * width_, width_);
    }
    std::span<const float> value(std::size_t key) const { return part(key, between_ == Between::cubic ? 1 : 0); }
    static Numbers copy(std::span<const float> values) { return {values.begin(), values.end()}; }

    /// glTF 2.0, appendix C.5: of each key the tangent before it, its value, and the tangent behind it.
    Numbers cubic(std::size_t last, double t, double step) const {
        const double t2 = t * t, t3 = t2 * t;
        Numbers sum(width_);
        for (std::size_t i = 0; i < width_; ++i)
            sum[i] = (2 * t3 - 3 * t2 + 1) * double(part(last, 1)[i]) +
                     step * (t3 - 2 * t2 + t) * double(part(last, 2)[i]) +
                     (3 * t2 - 2 * t3) * double(part(last + 1, 1)[i]) + step * (t3 - t2) * double(part(last + 1, 0)[i]);
        return sum;
    }

    std::vector<float> times_, values_;
    Between between_;
    std::size_t width_;  // numbers of a value
};

/// Names and numbers of members; none: it has no pointer.
std::vector<std::string> words_of_pointer(const At& target) {
    std::vector<std::string> words;
    for (const char c : target["extensions"]["KHR_animation_pointer"]["pointer"].text(""))
        if (c == '/')
            words.emplace_back();
        else if (!words.empty())
            words.back() += c;
    return words;
}

/// What a channel moves: names and numbers of members, from the root on. Empty: nothing that is known.
std::vector<std::string> target_of(const At& target, std::size_t nodes) {
    const std::string path = target["path"].text("");
    if (path != "pointer") {
        static const std::set<std::string, std::less<>> known{"translation", "rotation", "scale", "weights"};
        if (!target["node"]) {
            if (!target["extensions"]) target.warn(target.path() + " names no node: it moves nothing");
            return {};
        }
        if (!known.contains(path)) {
            target["path"].error("must be translation, rotation, scale, weights or pointer");
            return {};
        }
        const auto node = target["node"].index(nodes);
        return node ? std::vector<std::string>{"nodes", std::to_string(*node), path} : std::vector<std::string>{};
    }
    const auto words = words_of_pointer(target);
    static const std::set<std::string, std::less<>> may_move{"nodes", "meshes", "cameras", "materials", "extensions"};
    if (words.size() >= 2 && may_move.contains(words.front())) return words;
    const std::string pointer = target["extensions"]["KHR_animation_pointer"]["pointer"].text("");
    target.warn(fmt::format("what is animated at '{}' stands still", pointer.substr(0, 256)));
    return {};
}

/// Of a list; beyond its end, where a pointer gives no number.
std::size_t place_in(const std::string& word) {
    std::size_t place = 0;
    const auto [end, wrong] = std::from_chars(word.data(), word.data() + word.size(), place);
    return wrong == std::errc{} && end == word.data() + word.size() ? place : ~std::size_t{0};
}

class Mover {
public:
    Mover(const At& animation, double seconds, Document& document)
        : animation_(animation), seconds_(seconds), document_(document) {}

    void move() {
        const At channels = animation_["channels"];
        for (std::size_t i = 0; i < channels.size(); ++i) move(channels[i]);
    }

private:
    void move(const At& channel) {
        const At nodes = document_.root()["nodes"], samplers = animation_["samplers"];
        const auto target = target_of(channel["target"], nodes.size());
        const auto sampler = channel["sampler"].index(samplers.size());
        if (!channel["sampler"]) channel.error("names no sampler");
        if (target.empty() || !sampler) return;
        const bool of_parts = target.size() == 3 && target[0] == "nodes" && target[2] != "weights";
        if (of_parts && nodes[place_in(target[1])]["matrix"])
            return channel.warn("a node with a 'matrix' is animated: it stands still");
        const auto keys = keys_of(samplers[*sampler]);
        if (!keys) return;
        const std::size_t wanted = !of_parts ? keys->width() : target[2] == "rotation" ? 4 : 3;
        if (keys->width() != wanted) return samplers[*sampler]["output"].error("has not as many numbers as it moves");
        const Numbers value = keys->at(seconds_, target.back() == "rotation");
        if (!std::ranges::all_of(value, [](double number) { return std::isfinite(number); }))
            return samplers[*sampler].error("gives numbers that are not finite");
        if (!document_.put(target, value)) channel["target"].warn("what is animated is not there");
    }

    std::optional<Keys> keys_of(const At& sampler) {
        const auto between = between_of(sampler);
        auto times = document_.values(sampler["input"]), values = document_.values(sampler["output"]);
        if (!between || !times || !values) return std::nullopt;
        if (const auto fault = Keys::fault(*times, *values, *between); !fault.empty()) {
            sampler.error(fault);
            return std::nullopt;
        }
        Keys keys(*std::move(times), *std::move(values), *between);
        if (keys.jumps()) sampler.warn(sampler.path() + " has several keys at one time: it jumps there");
        return keys;
    }

    At animation_;
    double seconds_;
    Document& document_;
};

/// Those that are meant: of that name, of that number from 1 on, or all.
std::vector<At> chosen(const std::string& name, const Document& document) {
    const At all = document.root()["animations"];
    std::vector<std::string> names;
    for (std::size_t i = 0; i < all.size(); ++i) {
        names.push_back(all[i]["name"].text(""));
        if (names.back() == name) return {all[i]};
    }
    if (const auto number = place_in(name); number >= 1 && number <= all.size()) return {all[number - 1]};
    if (name == "*" && all.size() > 0) {
        std::vector<At> each;
        for (std::size_t i = 0; i < all.size(); ++i) each.push_back(all[i]);
        return each;
    }
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i].empty()) names[i] = std::to_string(i + 1);
    const auto guess = did_you_mean(name, names);
    throw UserError({document.path(), 0}, "there is no animation " + in_quotes(name) +
                                              (names.empty()   ? ": the file has none"
                                               : guess.empty() ? " (there is: " + joined(names) + ")"
                                                               : guess));
}

/// Where nobody chose one.
At first_of(const At& all) {
    if (const auto others = all.size() - 1; others > 0) {
        const std::string name = all[0]["name"].text("");
        all.warn(
            fmt::format("its first animation{} moves; the {} stand{} still (--animation, or the scene's 'animation', "
                        "chooses another, or all: '*')",
                        name.empty() ? "" : ", " + in_quotes(name) + ",",
                        others == 1 ? "other one" : fmt::format("{} others", others), others == 1 ? "s" : ""));
    }
    return all[0];
}

/// Nodes by number, whose weights a channel moves.
void add_morphing(const At& target, const At& nodes, std::set<std::size_t>& to) {
    if (target["path"].text("") == "weights") {
        if (target["node"])
            if (const auto node = target["node"].index(nodes.size())) to.insert(*node);
        return;
    }
    const auto words = words_of_pointer(target);
    if (words.size() < 3 || words[2] != "weights") return;
    const std::size_t place = place_in(words[1]);
    if (words[0] == "nodes") to.insert(place);
    for (std::size_t i = 0; words[0] == "meshes" && i < nodes.size(); ++i)
        if (nodes[i]["mesh"] && nodes[i]["mesh"].whole(~std::uint64_t{0}) == place) to.insert(i);
}

/// An accessor says it itself, as it has to.
double last_key(const At& input, Document& document) {
    const At accessors = document.root()["accessors"];
    const auto index = input.index(accessors.size());
    if (!index) return 0;
    if (const At most = accessors[*index]["max"][0]) return most.number(0);
    const auto times = document.values(input);
    return times && !times->numbers.empty() ? double(times->numbers.back()) : 0;
}

double length_of(const At& animation, Document& document) {
    const At samplers = animation["samplers"];
    double length = 0;
    for (std::size_t i = 0; i < samplers.size(); ++i)
        length = std::max(length, last_key(samplers[i]["input"], document));
    return length;
}

/// A pose, which has no length, is one at all times.
void warn_behind_end(const std::vector<At>& wanted, double seconds, Document& document) {
    double end = 0;
    for (const At& animation : wanted) end = std::max(end, length_of(animation, document));
    if (end > 0 && seconds > end)
        wanted.front().warn(
            fmt::format("its animation ends at {:.4g} s: behind that it stands still (a graph may repeat it: "
                        "'time = time % {:.4g}' in its scene)",
                        end, end));
}

}  // namespace

std::vector<SceneAnimation> animations_of(Document& document) {
    const At all = document.root()["animations"];
    std::vector<SceneAnimation> found;
    for (std::size_t i = 0; i < all.size(); ++i)
        found.push_back({all[i]["name"].text(""), length_of(all[i], document)});
    return found;
}

std::set<std::size_t> move_to(const Moment& moment, Document& document) {
    const At all = document.root()["animations"], nodes = document.root()["nodes"];
    std::set<std::size_t> morphing;
    if (!moment.animation && (!moment.seconds || all.size() == 0)) return morphing;
    const auto wanted = moment.animation ? chosen(*moment.animation, document) : std::vector{first_of(all)};
    warn_behind_end(wanted, moment.seconds.value_or(0), document);
    for (const At& animation : wanted) {
        const At channels = animation["channels"];
        for (std::size_t i = 0; i < channels.size(); ++i) add_morphing(channels[i]["target"], nodes, morphing);
        Mover(animation, moment.seconds.value_or(0), document).move();
    }
    return morphing;
}

}  // namespace lightnet::gltf
