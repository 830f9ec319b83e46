// lightnet view: a finished picture in a browser.
#include <CLI/CLI.hpp>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <thread>
#include <utility>

#include "core/base/error.hpp"
#include "core/film/exr.hpp"
#include "core/network/graph/graph_film.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/options.hpp"
#include "tools/explain/live_explainer.hpp"
#include "tools/explain/past_run.hpp"
#include "tools/pictures/picture_input.hpp"
#include "tools/request/run_settings.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/run_report.hpp"
#include "tools/support/signals.hpp"
#include "tools/watch/viewed_picture.hpp"
#include "tools/watch/watch_page.hpp"
#include "tools/watch/watch_server.hpp"
#include "tools/words/command_line.hpp"
#include "transport/wire/loopback.hpp"

namespace lightnet {
namespace {

constexpr auto looked_for_signals = std::chrono::milliseconds(50);

struct ViewOptions {
    std::string picture, other, report;
    WatchAddress at;
    bool insecure = false;
};

void describe_view(CLI::App& verb, ViewOptions& options) {
    verb.add_option("IMAGE", options.picture, "a picture as lightnet writes it; others have no layers to mix")
        ->required()
        ->type_name("IMAGE.exr");
    verb.add_option("OTHER", options.other,
                    "another of the same size, to be compared with: wiped over, in turns, apart")
        ->type_name("OTHER.exr");
    verb.add_option_function<std::string>(
            "--at", [&options](const std::string& text) { options.at = watch_address(text).value(); },
            "where the page is served (default: 127.0.0.1 and a free port)")
        ->type_name("ADDRESS[:PORT]")
        ->check([](const std::string& text) {
            return watch_address(text)
                       ? ""
                       : "the page is served at an address like 127.0.0.1:8080 or [::1]:8080, not at " + text;
        });
    verb.add_option("--report", options.report, "the report of its run, where it isn't beside the picture")
        ->type_name("FILE.run.json");
    verb.add_flag("--insecure", options.insecure, "serve beyond this machine although nothing is encrypted");
    when_taken_apart(verb, [&options]() -> std::optional<std::string> {
        if (options.insecure || options.at.stays_here()) return std::nullopt;
        return beyond_this_machine("--at " + in_url(options.at.host), "put a server with TLS in front of 127.0.0.1");
    });
    verb.footer(
        "Prints the page's address, and serves it until it is interrupted. Where the report of its run lies beside "
        "the\n"
        "picture (x.run.json), the page shows its network, and a click explains a pixel.\n\n"
        "Examples:\n"
        "  lightnet view cornell.exr\n"
        "  lightnet view cornell.exr cornell.clean.exr --at 127.0.0.1:8080");
}

PictureFile picture_file(const std::string& file) { return {file, layers_of_user(file)}; }

/// What is known of how a picture came about, and who tells of its pixels. None: nothing is.
class Origin {
public:
    /// Where a report was named and says something of another picture, that is an error; else it is told and left out.
    Origin(const ViewOptions& options, const ViewedPicture& viewed, const Launcher& launcher) {
        const bool said = !options.report.empty();
        const auto report = said ? options.report : report_beside(options.picture).string();
        if (!said && !std::filesystem::exists(report)) return;
        try {
            const PastRun past = read_past_run(report, launcher.registry);
            request_.graph = past.graph;
            request_.scene = scene_file(past.graph, launcher.registry);
            request_.seed = past.seed;
            request_.output = options.picture;
            FilmFormat format = film_format(request_, launcher.registry);
            if (format.layers != viewed.format().layers || format.width != viewed.format().width ||
                format.height != viewed.format().height)
                throw UserError({report, 0}, "tells of another picture: size or layers differ");
            explainer_ = std::make_unique<LiveExplainer>(request_, launcher.registry, std::move(format));
            explainer_->begin();
        } catch (const UserError& error) {
            if (said) throw;
            request_ = {};
            launcher.err << "lightnet: no pixel can be explained: " << error.what() << '\n';
        }
    }
    const Graph& graph() const { return request_.graph; }
    std::function<void(const PixelWish&, LiveExplainer::Reply)> explain() const {
        if (!explainer_) return {};
        return [teller = explainer_.get()](const PixelWish& wish, LiveExplainer::Reply reply) {
            teller->explain(wish, std::move(reply));
        };
    }

private:
    RunRequest request_;
    std::unique_ptr<LiveExplainer> explainer_;
};

int view(const ViewOptions& options, const Launcher& launcher) {
    std::optional<PictureFile> other;
    if (!options.other.empty()) other = picture_file(options.other);
    ViewedPicture viewed(picture_file(options.picture), std::move(other));
    const Origin origin(options, viewed, launcher);
    const auto& stop = watch_signals();

    WatchedState state;
    state.phase = "finished", state.done = 1;
    viewed.board()->tell(state_json(state, origin.graph()));
    WatchStage stage{viewed.hello(origin.graph(), launcher.registry), viewed.board(),
                     [](const WatchCommand& command) { command.answer("the picture is finished"); }, origin.explain()};
    WatchServer server({options.at, new_token(), watch_page()}, std::move(stage));
    viewed.show();
    launcher.out << server.url() << std::endl;
    if (!launcher.out) throw Error("the page's address can't be written to standard output");
    viewed.clean();
    while (!stop.any) std::this_thread::sleep_for(looked_for_signals);
    return exit_code::done;
}

}  // namespace

Verb view_verb() {
    return verb<ViewOptions>("view", "look at a picture and its layers in a browser, beside another", describe_view,
                             view);
}

}  // namespace lightnet
