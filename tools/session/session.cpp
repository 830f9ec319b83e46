#include "tools/session/session.hpp"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/joined.hpp"
#include "core/base/json.hpp"
#include "core/base/json_tree.hpp"
#include "core/base/words_of.hpp"
#include "tools/session/edit_queue.hpp"
#include "tools/session/edits_in_force.hpp"
#include "tools/session/handover.hpp"
#include "tools/session/run.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/pace.hpp"
#include "tools/support/signals.hpp"
#include "tools/watch/watch_page.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

/// Tells the other side what happens.
class Events {
public:
    explicit Events(std::ostream* out) : out_(out) {}

    /// False: nobody is there any more.
    bool sound() const { return !out_ || out_->good(); }

    void tell(const std::string& event, const std::string& words, std::map<std::string, JsonTree> members = {}) {
        JsonTree line{{"event", event}, {"edit", edits_}};
        if (!id_.empty()) line["id"] = JsonTree(parse_json(id_));
        for (auto& [name, value] : members) line[name] = std::move(value);
        if (server_) server_->tell(to_text({{"edited", line}}));
        if (out_)
            *out_ << to_text(line) << std::endl;
        else
            std::cerr << words << std::endl;
    }
    /// Those who watch are told, too.
    void show_to(WatchServer* server) { server_ = server; }
    /// `refused`: the edit has changed nothing.
    void tell(const UserError& error, bool refused) {
        JsonTree problems = JsonTree::list();
        for (const auto& [where, what] : error.problems())
            problems.push_back({{"file", where.file}, {"line", where.line}, {"what", what}});
        tell("error", error.what(), {{"problems", std::move(problems)}, {"refused", refused}});
    }
    void tell(const std::exception& error) { tell(UserError({"session", 0}, words_of(error)), false); }
    /// What is told next belongs to another edit; `id`: as JSON, "": it has none.
    void begin(const std::string& id) { ++edits_, id_ = id; }

private:
    std::ostream* out_;
    WatchServer* server_ = nullptr;
    std::uint64_t edits_ = 0;
    std::string id_;
};

class SessionRun {
public:
    SessionRun(const Session& session, const Registry& registry)
        : session_(session),
          registry_(registry),
          graph_(std::filesystem::absolute(session.graph).lexically_normal().string()),
          files_{session.graph},
          edits_(session.request),
          queue_(session.edits),
          events_(session.events) {}

    int perform() {
        open_to_watchers();
        queue_.watch(files_);
        while (true) {
            const int code = render();
            for (bool wanted = std::exchange(goes_on_, false); !wanted; wanted = take_news()) {
                if (stopped()) return leave(exit_code::interrupted);
                if (!events_.sound()) return exit_code::failed;
                if (ends_ && !queue_.signals().superseded)
                    return leave(edits_.refused() && code == exit_code::done ? exit_code::usage : code);
                queue_.wait();
            }
        }
    }

private:
    // False: the picture stays as it is.
    bool take_news() {
        const auto news = queue_.take();
        ends_ |= news.ended;
        if (news.lines.empty() && news.files.empty()) return false;
        edited_ = news.since.value_or(Clock::now());
        stop_ = seconds_since(edited_);
        if (!news.files.empty()) {
            events_.begin("");
            edits_.forget_files();
        }
        const bool scene_too = news.files.size() > 1 || !news.files.contains(graph_);
        if (!news.files.empty() && scene_too) handover_.forget_files();
        bool wanted = !news.files.empty() || !edits_.finished();
        for (const auto& line : news.lines) wanted |= take_line(line);
        return wanted;
    }

    // Whether it asks for another picture.
    bool take_line(const std::string& line) {
        events_.begin(id_of(line));
        try {
            const Edit edit = edit_of(line);
            const bool wanted = edit.changes() || !edit.end;
            if (wanted) edits_.take(edit);
            ends_ |= edit.end;
            return wanted;
        } catch (const UserError& error) {
            events_.tell(error, true);
        } catch (const Error& error) {
            events_.tell(UserError({"edit", 0}, error.what()), true);
        }
        edits_.refuse();
        return false;
    }

    int render() {
        int code = exit_code::usage;
        edits_.set_finished(false);
        try {
            RunRequest request = edits_.request();
            files_.insert(request.scene);
            request.shown = [this, &request](const PictureShown& shown) { tell(request, shown); };
            code = run(request, registry_, &handover_, queue_.signals());
            edits_.set_finished(code == exit_code::done);
        } catch (const UserError& error) {
            const bool refused = edits_.take_back();
            events_.tell(error, refused);
            goes_on_ = refused && !edits_.finished();
        } catch (const Error& error) {
            code = exit_code::failed;
            events_.tell(error);
        }
        look_after_files();
        return code;
    }

    // Those of a scene that can't be read stay in view, as they will be mended.
    void look_after_files() {
        if (const auto& read = handover_.read()) {
            files_ = {session_.graph};
            for (const auto& [file, bytes] : read->files.seen()) files_.insert(file);
        }
        queue_.watch(files_);
    }

    void open_to_watchers() {
        if (!session_.watch) return;
        WatchServer::Options options{*session_.watch, new_token(), watch_page()};
        options.edit = [this](std::string line) { queue_.add(std::move(line)); };
        options.end = ask_to_stop;
        server_.emplace(std::move(options), stage_before_runs());
        handover_.server = &*server_;
        events_.show_to(&*server_);
        std::cerr << "watch it at " << server_->url() << std::endl;
    }

    bool stopped() const { return queue_.signals().interrupted || queue_.signals().terminated; }

    void tell(const RunRequest& request, const PictureShown& shown) {
        look_after_files();
        edits_.shown();
        const double seconds = seconds_since(edited_);
        JsonTree warnings = JsonTree::list();
        for (const auto& warning : shown.warnings) warnings.push_back(warning);
        JsonTree took{{"stop", stop_}, {"read", edits_.read_seconds()}};
        std::map<std::string, double> parts;  // one that is there twice: of a look, and of what follows it
        for (const auto& [part, its_seconds] : shown.took) parts[part] += its_seconds;
        for (const auto& [part, its_seconds] : parts) took[part] = its_seconds;
        std::map<std::string, JsonTree> members{
            {"file", request.output},         {"samples", shown.samples}, {"coarse", shown.coarse},
            {"finished", shown.finished},     {"seconds", seconds},       {"took", std::move(took)},
            {"warnings", std::move(warnings)}};
        JsonTree without = JsonTree::list();
        for (const auto& layer : shown.without) without.push_back(layer);
        if (!shown.without.empty()) members["without"] = std::move(without);
        events_.tell("picture",
                     fmt::format("{}: {:.10g} samples per pixel, {:.2f} s{}{}", request.output, shown.samples, seconds,
                                 shown.finished ? "" : " so far",
                                 shown.without.empty() ? "" : ", without " + joined(shown.without)),
                     std::move(members));
    }

    int leave(int code) {
        events_.tell("end", "the session is over");
        return code;
    }

    const Session& session_;
    const Registry& registry_;
    const std::string graph_;      // its file, by its absolute name
    std::set<std::string> files_;  // of the graph, and of the scene that was read last
    EditsInForce edits_;
    Handover handover_;
    EditQueue queue_;
    std::optional<WatchServer> server_;  // before those whom it calls are gone
    Events events_;
    Clock::time_point edited_ = Clock::now();
    double stop_ = 0;       // seconds until the picture at work had ended
    bool ends_ = false;     // with the picture at work
    bool goes_on_ = false;  // with the picture before an edit that was taken back
};

}  // namespace

int run_session(const Session& session, const Registry& registry) { return SessionRun(session, registry).perform(); }

}  // namespace lightnet
