#include "core/readers/common/light_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "core/base/math/sampling.hpp"
#include "core/base/math/sky_layout.hpp"
#include "core/readers/files/trimmed.hpp"

namespace lightnet {
namespace {

constexpr double most_angles = 1 << 16;

[[noreturn]] void not_a_profile(const std::string& what) { throw Error("light profile: " + what); }

/// Text, line by line, and then number by number.
class ProfileText {
public:
    explicit ProfileText(std::string_view text) : rest_(text) {}

    bool at_end() const { return rest_.empty(); }
    std::string_view line() {
        const auto end = rest_.find_first_of("\r\n");
        const std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(std::min(line.size() + 1, rest_.size()));
        return line;
    }
    double number(const char* what) {
        while (!rest_.empty() && is_between(rest_.front())) rest_.remove_prefix(1);
        if (rest_.empty()) not_a_profile(fmt::format("it ends before {}", what));
        if (rest_.size() > 1 && rest_[0] == '+') rest_.remove_prefix(1);
        double value = 0;
        const auto [end, problem] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
        const auto length = static_cast<std::size_t>(end - rest_.data());
        if (problem != std::errc{} || !std::isfinite(value) || (length < rest_.size() && !is_between(rest_[length])))
            not_a_profile(fmt::format("{} is not a number", what));
        rest_.remove_prefix(length);
        return value;
    }
    /// A whole number of things, 1 at least; each takes two bytes of the file or more.
    std::size_t count(const char* what, double most = most_angles) {
        const double value = number(what);
        if (!(value >= 1 && value <= most && value == std::floor(value)))
            not_a_profile(fmt::format("{} is {}, not a whole number from 1 on", what, value));
        if (value > double(rest_.size())) not_a_profile(fmt::format("it ends before {}", what));
        return static_cast<std::size_t>(value);
    }

private:
    static bool is_between(char c) {
        return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',' || c == '\x1a';
    }

    std::string_view rest_;
};

/// What stands behind "TILT=" of a line; none: it is another one.
std::optional<std::string_view> tilt_in(std::string_view line) {
    constexpr std::string_view blanks = " \t", word = "TILT";
    line = trimmed(line, blanks);
    if (!line.starts_with(word)) return std::nullopt;
    line = trimmed(line.substr(word.size()), blanks);
    if (!line.starts_with('=')) return std::nullopt;
    return trimmed(line.substr(1), blanks);
}

std::vector<float> ascending_angles(ProfileText& text, std::size_t count, const char* what) {
    std::vector<float> angles;
    for (std::size_t i = 0; i < count; ++i) {
        angles.push_back(static_cast<float>(text.number(what)));
        if (std::fabs(angles[i]) > 360) not_a_profile(fmt::format("{} is {}", what, angles[i]));
        if (i > 0 && !(angles[i] > angles[i - 1])) not_a_profile(fmt::format("{} does not ascend", what));
    }
    return angles;
}

/// How the lamp lies, angles and factors (LM-63-2002, 5.8 to 5.11).
LampTilt tilt_of(ProfileText& text) {
    LampTilt tilt;
    const double lamp = text.number("how the lamp lies");
    if (lamp != 1 && lamp != 2 && lamp != 3) not_a_profile(fmt::format("a lamp lies by 1, 2 or 3, not by {}", lamp));
    tilt.lamp = static_cast<LampTilt::Lamp>(int(lamp));
    const std::size_t count = text.count("the number of angles of tilt");
    tilt.angles = ascending_angles(text, count, "an angle of tilt");
    for (std::size_t i = 0; i < count; ++i) {
        const double factor = text.number("a factor of tilt");
        if (!(factor >= 0 && factor < 1e6)) not_a_profile(fmt::format("a factor of tilt is {}", factor));
        tilt.factors.push_back(static_cast<float>(factor));
    }
    return tilt;
}

/// Behind the labels, to the numbers.
void take_tilt(ProfileText& text, const TiltFile& tilt_file, LightProfile& profile) {
    while (true) {
        if (text.at_end()) not_a_profile("there is no line that begins with 'TILT='");
        const auto tilt = tilt_in(text.line());
        if (!tilt) continue;
        if (*tilt == "NONE") return;
        if (*tilt == "INCLUDE") {
            profile.tilt = tilt_of(text);
            return;
        }
        const std::string name(*tilt);
        if (const auto other = tilt_file ? tilt_file(name) : std::nullopt) {
            ProfileText there(*other);
            profile.tilt = tilt_of(there);
        } else {
            profile.tilt_missing = name;
        }
        return;
    }
}

/// The angles between which one lies, and the share of the second. None: it lies beyond them.
struct Around {
    std::size_t first = 0, second = 0;
    float share = 0;
    bool found = false;
};
Around around(const std::vector<float>& angles, float at) {
    constexpr float rounding = 1e-3f;
    if (at < angles.front() - rounding || at > angles.back() + rounding) return {};
    const auto above = std::upper_bound(angles.begin(), angles.end(), at);
    if (above == angles.begin()) return {0, 0, 0, true};
    if (above == angles.end()) return {angles.size() - 1, angles.size() - 1, 0, true};
    const auto second = static_cast<std::size_t>(above - angles.begin());
    return {second - 1, second, (at - angles[second - 1]) / (angles[second] - angles[second - 1]), true};
}

/// An angle around the vertical, 0 … 360 degrees, where it was measured: by LM-63 all around, over one half (0 to 180,
/// or 90 to 270), over a quarter, or in one plane that stands for all.
float folded_turn(const std::vector<float>& angles, float turn) {
    if (angles.size() == 1) return angles[0];
    const float first = angles.front(), last = angles.back();
    if (last > 270 || (first > 0 && last < 180)) return turn < first ? turn + 360 : turn;
    if (first >= 90 && last <= 270) return turn < 90 ? 180 - turn : turn > 270 ? 540 - turn : turn;
    if (turn > 180) turn = 360 - turn;
    return last <= 90 && turn > 90 ? 180 - turn : turn;
}

/// All around, the last plane is the first once more; some files leave it out.
void close_circle(LightProfile& profile) {
    auto& turns = profile.horizontal;
    const bool open = turns.front() == 0 && turns.back() > 270 && turns.back() < 360;
    if (profile.photometry != LightProfile::Photometry::c || !open) return;
    turns.push_back(360);
    const std::vector<float> first(profile.candela.begin(),
                                   profile.candela.begin() + std::ptrdiff_t(profile.vertical.size()));
    profile.candela.insert(profile.candela.end(), first.begin(), first.end());
}

float degrees(float y, float x) { return std::atan2(y, x) * 180 / pi; }

}  // namespace

float LightProfile::towards(Vec3 d) const {
    float up = 0, turn = 0;
    if (photometry == Photometry::c) {
        up = degrees(std::hypot(d.x, d.y), -d.z);
        turn = degrees(d.y, d.x);
        turn = folded_turn(horizontal, turn < 0 ? turn + 360 : turn);
    } else {
        const bool b = photometry == Photometry::b;
        // along the axis around which the other angle turns
        const float along = b ? d.x : d.y, across = b ? d.y : d.x;
        const float from_middle = degrees(along, std::hypot(across, d.z)), around_axis = degrees(across, -d.z);
        up = b ? around_axis : from_middle, turn = b ? from_middle : around_axis;
        if (vertical.front() >= 0) up = std::fabs(up);
        if (horizontal.front() >= 0) turn = std::fabs(turn);
    }
    const Around v = around(vertical, up), h = around(horizontal, turn);
    if (!v.found || !h.found) return 0;
    const auto plane = [&](std::size_t at) {
        const float* values = &candela[at * vertical.size()];
        return values[v.first] + (values[v.second] - values[v.first]) * v.share;
    };
    return plane(h.first) + (plane(h.second) - plane(h.first)) * h.share;
}

LightProfile read_light_profile(std::string_view text, const TiltFile& tilt_file) {
    text = without_byte_order_mark(text);
    // since 1995 the first line names the edition, and one factor is something else: of 2019, how the file was made
    const bool newer = text.starts_with("IESNA:LM-63-") || text.starts_with("IES:LM-63-");
    ProfileText input(text);
    LightProfile profile;
    take_tilt(input, tilt_file, profile);
    input.number("the number of lamps"), input.number("the lumens of a lamp");
    double factor = input.number("the factor of all candelas");
    const std::size_t verticals = input.count("the number of vertical angles"),
                      horizontals = input.count("the number of horizontal angles");
    const double type = input.number("the type of photometry");
    if (type != 1 && type != 2 && type != 3) not_a_profile(fmt::format("there is no type of photometry {}", type));
    profile.photometry = static_cast<LightProfile::Photometry>(int(type));
    for (const char* what : {"its units", "its width", "its length", "its height"}) input.number(what);
    factor *= input.number("the factor of the ballast");
    const double of_lamp = input.number("the factor of ballast and lamp");
    if (!newer && of_lamp > 0) factor *= of_lamp;
    input.number("its watts");
    profile.vertical = ascending_angles(input, verticals, "a vertical angle");
    profile.horizontal = ascending_angles(input, horizontals, "a horizontal angle");
    for (std::size_t i = 0; i < verticals * horizontals; ++i) {
        const double candela = input.number("the last candela") * factor;
        if (!(std::fabs(candela) < 1e30)) not_a_profile("a light is brighter than any lamp");
        profile.candela.push_back(static_cast<float>(std::max(candela, 0.0)));
    }
    close_circle(profile);
    return profile;
}

std::string lacks_of_tilt(const LightProfile& profile, bool up_known) {
    const std::string straight = "it shines as where it hangs straight";
    if (!profile.tilt_missing.empty())
        return "how the lamp's light changes as it is tilted is left out, as '" + profile.tilt_missing.substr(0, 256) +
               "' can't be read: " + straight;
    if (!profile.tilt.varies() || up_known) return "";
    return "how the lamp's light changes as it is tilted is left out, as nothing says where down is: " + straight;
}

// DECISIONS: profiles-are-pictures
EnvironmentData pattern_of(const LightProfile& profile, const Matrix& to_world) {
    const bool even = profile.photometry == LightProfile::Photometry::c && profile.horizontal.size() == 1;
    const std::uint32_t wide = even ? 4 : 720, high = 720;
    std::vector<Rgb> pixels;
    pixels.reserve(std::size_t{wide} * high);
    for (std::uint32_t y = 0; y < high; ++y)
        for (std::uint32_t x = 0; x < wide; ++x) {
            const Vec3 d = from_latitude_longitude({(float(x) + 0.5f) / float(wide), (float(y) + 0.5f) / float(high)});
            // the picture's top is up, its middle at -z
            pixels.push_back(Rgb{1, 1, 1} * profile.towards({d.x, -d.z, d.y}));
        }
    EnvironmentData pattern;
    pattern.image = std::make_shared<const Image>(wide, high, pixels);
    Matrix axes;  // x, y, z of the picture in those of the luminaire
    axes.m[0] = {1, 0, 0, 0}, axes.m[1] = {0, 0, -1, 0}, axes.m[2] = {0, 1, 0, 0};
    pattern.to_world = to_world * axes;
    return pattern;
}

}  // namespace lightnet
