#include "tools/cli/trouble_options.hpp"

#include <CLI/CLI.hpp>

#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

constexpr const char* group = "Faults of local workers, to see what a run does about them";
constexpr std::string_view workers = "worker";  // worker1, worker2, …
constexpr double most_times = 1000;

using Trouble = std::pair<std::uint32_t, double>;

template <class Number>
bool read_all(std::string_view text, Number& number) {
    const auto [end, fault] = std::from_chars(text.begin(), text.end(), number);
    return fault == std::errc{} && end == text.end();
}

// "worker2=8" with '=', "worker2@30%" with '@' and '%' behind.
std::optional<Trouble> trouble_in(std::string_view text, char sign, std::string_view behind) {
    Trouble trouble;
    const auto at = text.find(sign);
    if (at == std::string_view::npos || !text.starts_with(workers) || !text.ends_with(behind)) return std::nullopt;
    const auto number = text.substr(workers.size(), at - workers.size());
    const auto amount = text.substr(at + 1, text.size() - at - 1 - behind.size());
    if (!read_all(number, trouble.first) || !read_all(amount, trouble.second) || trouble.first < 1) return std::nullopt;
    return trouble;
}

std::optional<Trouble> slowness_in(const std::string& text) {
    const auto slow = trouble_in(text, '=', "");
    return slow && slow->second >= 1 && slow->second <= most_times ? slow : std::nullopt;
}

std::optional<Trouble> loss_in(const std::string& text) {
    auto loss = trouble_in(text, '@', "%");
    if (!loss || !(loss->second >= 0 && loss->second <= 100)) return std::nullopt;
    loss->second /= 100;
    return loss;
}

void add_trouble(CLI::App& verb, const char* name, std::map<std::uint32_t, double>& troubles, const char* help,
                 const char* type, std::optional<Trouble> (*parse)(const std::string&), const std::string& like) {
    const auto add = [&troubles, parse](const std::vector<std::string>& given) {
        for (const auto& one : given) troubles.insert_or_assign(parse(one)->first, parse(one)->second);
    };
    verb.add_option_function<std::vector<std::string>>(name, add, help)
        ->type_name(type)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->needs(verb.get_option("--local-workers"))
        ->group(group)
        ->check([parse, like](const std::string& text) { return parse(text) ? "" : like + ", not " + text; });
}

}  // namespace

void add_troubles(CLI::App& verb, FaultInjection& troubles) {
    const auto set_delay = [&troubles](std::uint32_t delay) { troubles.delay = std::chrono::milliseconds(delay); };
    takes_numbers(verb.add_option_function<std::uint32_t>(
                      "--delay", set_delay, "milliseconds that everything takes longer to and from each of them"),
                  "MS", 0, 10'000)
        ->needs(verb.get_option("--local-workers"))
        ->group(group);
    add_trouble(verb, "--slow", troubles.slow,
                "makes all that a worker does take so many times as long (may be repeated)", "WORKER=TIMES",
                slowness_in, "slowness is like worker2=8, from 1 to 1000");
    add_trouble(verb, "--lose", troubles.lose,
                "kills a worker when this share of the picture is there (may be repeated)", "WORKER@SHARE%", loss_in,
                "a loss is like worker2@30%, from 0 to 100");
}

std::optional<std::string> mistake_in(const FaultInjection& troubles, std::uint32_t local_workers) {
    for (const auto& [option, map] : {std::pair{"--slow", &troubles.slow}, {"--lose", &troubles.lose}})
        for (const auto& [number, amount] : *map)
            if (number > local_workers)
                return std::string(option) + ": there is no worker" + std::to_string(number) + " among " +
                       std::to_string(local_workers) + " local workers";
    return std::nullopt;
}

}  // namespace lightnet
