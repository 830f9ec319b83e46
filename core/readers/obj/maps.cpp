#include "core/readers/obj/maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string_view>
#include <vector>

namespace lightnet::obj {
namespace {

/// Of one number for each place.
bool is_of_numbers(std::string_view statement) {
    static const std::set<std::string_view> known{"map_d", "map_Pr", "map_Pm", "map_bump", "map_Bump", "bump"};
    return known.contains(statement);
}

class Options {
public:
    Options(Lines& lines, Report& report) : lines_(lines), report_(report) {}

    void choose_channel(Map& map) {
        using Channel = ImageTexture::Channel;
        static const std::map<std::string, Channel, std::less<>> channels{{"r", Channel::red},
                                                                          {"g", Channel::green},
                                                                          {"b", Channel::blue},
                                                                          {"m", Channel::alpha},
                                                                          {"l", Channel::luminance}};
        const auto word = lines_.word();
        if (const auto known = channels.find(word); known != channels.end())
            map.channel = known->second;
        else
            report_.warn(map.where, fmt::format("option '-imfchan {}' of a map is left out: it is as without",
                                                word.substr(0, 32)));
    }

    void read(const std::string& option, Map& map) {
        if (option == "-clamp") {
            map.clamp = lines_.word() == "on";
        } else if (option == "-bm") {
            map.bump = lines_.number(report_).value_or(1);
        } else if (option == "-s" || option == "-o") {
            Vec2& pair = option == "-s" ? map.scale : map.offset;
            const auto values = numbers_ahead(3);
            if (!values.empty()) pair.x = values[0];
            if (values.size() > 1) pair.y = values[1];
        } else if (option == "-t" || option == "-mm") {
            const auto values = numbers_ahead(option == "-t" ? 3 : 2);
            // the first is the base: what is added to all of it, or how far it is moved
            const bool moved = option == "-t" && std::ranges::any_of(values, [](float value) { return value != 0; });
            const bool lifted = option == "-mm" && !values.empty() && values[0] != 0;
            if (option == "-mm" && values.size() > 1 && !lifted) map.gain = values[1];
            if (moved || lifted)
                report_.warn(map.where, fmt::format("option '{}' of a map is left out: it is as without", option));
        } else if (option == "-cc" || option == "-imfchan" || option == "-boost" || option == "-colorspace") {
            const std::string value(lines_.word().substr(0, 32));
            if (option != "-cc" || value != "off")
                report_.warn(map.where,
                             fmt::format("option '{} {}' of a map is left out: it is as without", option, value));
        } else if (option == "-blendu" || option == "-blendv" || option == "-type" || option == "-texres") {
            lines_.word();  // of no effect on what is there
        } else {
            report_.warn(map.where, fmt::format("unknown option '{}' of a map is left out: it is as without",
                                                option.substr(0, 32)));
        }
    }

private:
    /// Up to so many numbers; stops before a word that is none.
    std::vector<float> numbers_ahead(std::size_t most) {
        std::vector<float> values;
        while (values.size() < most) {
            auto ahead = lines_;
            const auto word = ahead.word();
            if (word.empty() || word.find_first_not_of("+-.0123456789eE") != word.npos) break;
            const auto value = lines_.number(report_);
            if (!value) break;
            values.push_back(*value);
        }
        return values;
    }

    Lines& lines_;
    Report& report_;
};

}  // namespace

std::optional<Map> read_map(const std::string& statement, Lines& lines, Report& report) {
    Map map;
    map.where = lines.where();
    Options options(lines, report);
    for (;;) {
        auto ahead = lines;
        const std::string option(ahead.word());
        if (!option.starts_with('-')) break;
        lines = ahead;
        if (option == "-imfchan" && is_of_numbers(statement))
            options.choose_channel(map);
        else
            options.read(option, map);
    }
    map.file = lines.rest();
    if (!map.file.empty()) return map;
    report.warn(map.where, fmt::format("'{}' names no file and is left out", statement));
    return std::nullopt;
}

}  // namespace lightnet::obj
