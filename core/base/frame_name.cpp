#include "core/base/frame_name.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <optional>

namespace lightnet {
namespace {

struct PlaceInName {
    std::size_t begin = 0, size = 0, digits = 0;
};

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

/// "%d" or "%04d" from there on, and no word like "%done".
std::optional<PlaceInName> printed(std::string_view name, std::size_t at) {
    std::size_t end = at + 1, digits = 1;
    if (end < name.size() && name[end] == '0') {
        if (++end == name.size() || !is_digit(name[end])) return std::nullopt;
        digits = static_cast<std::size_t>(name[end++] - '0');
    }
    if (end == name.size() || name[end] != 'd') return std::nullopt;
    if (end + 1 < name.size() && is_letter(name[end + 1])) return std::nullopt;
    return PlaceInName{at, end + 1 - at, digits};
}

/// The last one, as folders may have numbers, too. One # alone is a letter like others.
std::optional<PlaceInName> place_in(std::string_view name) {
    if (const auto end = name.rfind("##"); end != std::string_view::npos) {
        std::size_t begin = end;
        while (begin > 0 && name[begin - 1] == '#') --begin;
        return PlaceInName{begin, end + 2 - begin, end + 2 - begin};
    }
    for (auto at = name.rfind('%'); at != std::string_view::npos; at = at ? name.rfind('%', at - 1) : name.npos)
        if (const auto place = printed(name, at)) return place;
    return std::nullopt;
}

}  // namespace

bool has_frame_place(std::string_view name) { return place_in(name).has_value(); }

std::string with_frame(std::string_view name, int frame) {
    const auto place = place_in(name);
    if (!place) return std::string(name);
    std::string number = std::to_string(std::abs(frame));
    if (number.size() < place->digits) number.insert(0, place->digits - number.size(), '0');
    if (frame < 0) number.insert(0, 1, '-');
    return std::string(name.substr(0, place->begin)) + number + std::string(name.substr(place->begin + place->size));
}

std::string without_frame_place(std::string_view name) {
    const auto place = place_in(name);
    if (!place) return std::string(name);
    std::string before(name.substr(0, place->begin)), behind(name.substr(place->begin + place->size));
    const bool parted = before.size() > 1 && std::string_view("._-").find(before.back()) != std::string_view::npos;
    if (parted && before[before.size() - 2] != '/') before.pop_back();
    return before + behind;
}

std::string frame_place_for(std::string_view name) {
    const auto dot = name.rfind('.');
    const auto stem = name.substr(0, std::min(dot, name.size()));
    std::size_t begin = stem.size();
    while (begin > 0 && is_digit(stem[begin - 1])) --begin;
    if (begin == stem.size()) return {};
    const std::size_t digits = std::max<std::size_t>(stem.size() - begin, 2);
    return std::string(stem.substr(0, begin)) + std::string(digits, '#') + std::string(name.substr(stem.size()));
}

}  // namespace lightnet
