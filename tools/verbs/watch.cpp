// lightnet watch: shows how a run stands, in a terminal.
#include <CLI/CLI.hpp>

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <optional>

#include "core/base/error.hpp"
#include "core/base/json_tree.hpp"
#include "core/base/plain_file.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/http/live_line.hpp"
#include "tools/http/watch_rules.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/watch/run_table.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;

constexpr auto redraw_interval = 500ms;
constexpr auto first_state = 10s;    // until a launcher has said how the run stands
constexpr auto obeyed_within = 60s;  // a wish: it may be at something else

struct WatchOptions {
    std::string what;  // a report's file, or where a run can be watched
    bool end = false, write = false;
    std::string drain;  // host
};

void describe_watch(CLI::App& verb, WatchOptions& options) {
    verb.add_option("WHAT", options.what, "where a run can be watched (as it says itself), or the report of one")
        ->required()
        ->type_name("URL|FILE.run.json");
    auto* const end = verb.add_flag("--end", options.end, "end the run; what is there is kept");
    auto* const write = verb.add_flag("--write", options.write, "have the picture so far written now")->excludes(end);
    verb.add_option("--drain", options.drain, "take this host out: it finishes what it has, and leaves the run")
        ->type_name("HOST")
        ->excludes(end)
        ->excludes(write);
    verb.footer(
        "On a terminal it is drawn anew until the run ends; elsewhere it is printed once.\n"
        "Exit codes: 0 it was shown, or done; 1 the launcher is gone, or couldn't do it; 2 there is no such report, "
        "address\n"
        "or host.\n\n"
        "Examples:\n"
        "  lightnet watch 'http://127.0.0.1:40123/#3c1f'\n"
        "  lightnet watch cornell.run.json");
}

struct TerminalSize {
    std::size_t columns = 0, rows = 0;  // 0: it is none
};
TerminalSize terminal_size(const std::ostream& out) {
    winsize size{};
    if (&out != &std::cout || !::isatty(STDOUT_FILENO) || ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return {};
    return {size.ws_col ? size.ws_col : std::size_t{80}, size.ws_row ? size.ws_row : std::size_t{24}};
}

// Draws over what it has drawn before, and leaves what stood above as it is.
class Redrawing {
public:
    explicit Redrawing(std::ostream& out) : out_(out) {}
    void draw(const RunTable& table) {
        const auto size = terminal_size(out_);
        const auto text = to_text(table, size.columns, size.rows);
        if (drawn_) out_ << "\x1b[" << std::min(drawn_, size.rows ? size.rows - 1 : drawn_) << "A\r\x1b[J";
        out_ << text << std::flush;
        drawn_ = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    }

private:
    std::ostream& out_;
    std::size_t drawn_ = 0;  // lines
};

int print_report(const std::string& file, const Launcher& launcher) try {
    constexpr std::uint64_t most_bytes = std::uint64_t{256} << 20;
    launcher.out << to_text(table_of_report(PlainFile(file, most_bytes).text()), terminal_size(launcher.out).columns,
                            0);
    return exit_code::done;
} catch (const UserError&) {
    throw;
} catch (const Error& error) {
    throw UserError({file, 0}, std::string("can't be read (") + error.what() +
                                   "); a report is like cornell.run.json, an address like "
                                   "http://127.0.0.1:40123/#3c1f");
}

std::optional<std::string> wish_of(const WatchOptions& options) {
    if (options.end) return "end";
    if (options.write) return "write";
    if (!options.drain.empty()) return "drain";
    return std::nullopt;
}

// Hears what the launcher says until `told`; false: it takes too long, or the launcher is gone.
template <class Told>
bool hear_until(Told told, LiveTable& table, LiveLine& line, std::chrono::steady_clock::duration patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!told() && std::chrono::steady_clock::now() < end) {
        if (const auto text = line.next(redraw_interval))
            table.hear(*text);
        else if (line.is_over())
            break;
    }
    return told();
}

int ask_for(const std::string& wish, const WatchOptions& options, LiveLine& line, const std::string& token) {
    line.say(to_text({{"do", wish}, {"host", options.drain}, {"token", token}}, {.strict = true}));
    LiveTable table;
    if (!hear_until([&] { return table.allowed().has_value(); }, table, line, first_state))
        throw Error("the launcher does not answer");
    if (!*table.allowed())
        throw UserError({options.what, 0}, "has not the token of this run: what stands behind the # in its address");
    if (!hear_until([&] { return table.why_not().has_value(); }, table, line, obeyed_within))
        throw Error(line.is_over() ? "the launcher is gone, and has not said whether it was done"
                                   : "the launcher has not said so far whether it was done; it may still be");
    const auto& why_not = *table.why_not();
    if (!why_not.empty() && wish == "drain") throw UserError({options.what, 0}, why_not);
    if (!why_not.empty()) throw Error(why_not);
    return exit_code::done;
}

int show_live(LiveLine& line, const Launcher& launcher) {
    const bool terminal = terminal_size(launcher.out).rows != 0;
    const auto begun = std::chrono::steady_clock::now();
    LiveTable table;
    Redrawing drawing(launcher.out);
    auto due = begun;
    while (table.outcome().empty() && !line.is_over()) {
        if (const auto text = line.next(redraw_interval / 2)) table.hear(*text);
        const auto now = std::chrono::steady_clock::now();
        // Rates are told from the second word on.
        const bool told = table.table().hosts.size() && now - begun > 2s;
        if (!terminal && (told || now - begun > first_state)) break;
        if (!terminal || now < due || !table.changed()) continue;
        drawing.draw(table.table());
        due = now + redraw_interval;
    }
    drawing.draw(table.table());
    if (!line.is_over() || !table.outcome().empty()) return exit_code::done;
    launcher.err << "lightnet: the launcher is gone\n";
    return exit_code::failed;
}

int watch(const WatchOptions& options, const Launcher& launcher) {
    if (!options.what.starts_with("http:") && !options.what.starts_with("https:")) {
        if (wish_of(options))
            throw UserError({options.what, 0}, "is a report: only a run that goes on can be told something");
        return print_report(options.what, launcher);
    }
    const auto url = watch_url(options.what);
    if (!url)
        throw UserError(
            {options.what, 0},
            "is no address of a run: these are like http://127.0.0.1:40123/#3c1f (to one that TLS stands in "
            "front of, ssh -L leads)");
    LiveLine line(url->at.host, url->at.port, "/words");
    if (const auto wish = wish_of(options)) return ask_for(*wish, options, line, url->token);
    return show_live(line, launcher);
}

}  // namespace

Verb watch_verb() { return verb<WatchOptions>("watch", "show how a run stands, in a terminal", describe_watch, watch); }

}  // namespace lightnet
