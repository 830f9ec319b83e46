#include "core/film/gains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "core/base/between_commas.hpp"
#include "core/base/error.hpp"
#include "core/base/in_quotes.hpp"
#include "core/base/joined.hpp"
#include "core/base/suggestion.hpp"

namespace lightnet {
namespace {

// None: not a number that a gain may be.
std::optional<float> gain_number(std::string_view text) {
    float number = 0;
    const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (wrong != std::errc() || end != text.data() + text.size()) return std::nullopt;
    if (!std::isfinite(number) || number < 0) return std::nullopt;
    return number;
}

// "direct.key": the light of a group of lamps by way of a node.
std::string node_of(const std::string& layer) { return layer.substr(0, layer.find('.')); }
std::string group_of(const std::string& layer) {
    const auto dot = layer.find('.');
    return dot == std::string::npos ? "" : layer.substr(dot + 1);
}

bool names(const std::string& gain, const std::string& layer) {
    return gain == layer || gain == node_of(layer) || gain == group_of(layer);
}

// All that a gain may name.
std::vector<std::string> with_parts(const std::vector<std::string>& layers) {
    std::vector<std::string> all = layers;
    for (const auto& layer : layers)
        for (const auto& part : {node_of(layer), group_of(layer)})
            if (!part.empty() && std::find(all.begin(), all.end(), part) == all.end()) all.push_back(part);
    return all;
}

}  // namespace

Gain gain_of(std::string_view text) {
    const auto equals = text.find('=');
    const auto wrong = [&] {
        return Error("a gain is like bounce=0.5 or bounce=1.2,1.1,1 (red, green, blue; 0 or more), not " +
                     in_quotes(text));
    };
    if (equals == std::string_view::npos || equals == 0) throw wrong();
    std::vector<float> numbers;
    for (const auto& part : between_commas(text.substr(equals + 1))) {
        const auto number = gain_number(part);
        if (!number) throw wrong();
        numbers.push_back(*number);
    }
    if (numbers.size() == 1) numbers.resize(3, numbers.front());
    if (numbers.size() != 3) throw wrong();
    return {std::string(text.substr(0, equals)), {numbers[0], numbers[1], numbers[2]}};
}

std::string to_string(const Gain& gain) {
    const auto [r, g, b] = gain.value;
    return r == g && g == b ? fmt::format("{}={}", gain.layer, r) : fmt::format("{}={},{},{}", gain.layer, r, g, b);
}

std::vector<std::string> mistakes_in(const std::vector<Gain>& gains, const std::vector<std::string>& layers) {
    std::vector<std::string> mistakes;
    std::set<std::string> seen;
    for (const auto& gain : gains) {
        if (std::none_of(layers.begin(), layers.end(), [&](const auto& layer) { return names(gain.layer, layer); }))
            mistakes.push_back("there is no layer " + in_quotes(gain.layer) +
                               did_you_mean(gain.layer, with_parts(layers)) + "; the layers are " + joined(layers));
        else if (!seen.insert(gain.layer).second)
            mistakes.push_back("layer " + in_quotes(gain.layer) + " has more than one gain");
    }
    return mistakes;
}

std::vector<Rgb> one_for_each(const std::vector<Gain>& gains, const std::vector<std::string>& layers) {
    std::vector<Rgb> all;
    if (gains.empty()) return all;
    for (const auto& layer : layers) {
        std::vector<std::string> parts{layer};  // in the order in which their gains count
        if (group_of(layer) != "") parts = {node_of(layer), group_of(layer), layer};
        Rgb value{1, 1, 1};
        for (const auto& part : parts)
            for (const auto& gain : gains)
                if (gain.layer == part) value *= gain.value;
        all.push_back(value);
    }
    return all;
}

void mix(Picture& picture, const std::vector<Gain>& gains) {
    std::vector<std::string> names;
    for (const auto& layer : picture.layers) names.push_back(layer.name);
    if (const auto mistakes = mistakes_in(gains, names); !mistakes.empty()) throw Error(joined(mistakes, "\n"));
    const auto values = one_for_each(gains, names);
    for (std::size_t k = 0; k < names.size(); ++k) picture.layers[k].gain = values.empty() ? Rgb{1, 1, 1} : values[k];
    make_beauty(picture);
}

}  // namespace lightnet
