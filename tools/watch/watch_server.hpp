// Serves the page of a run, and what it shows, to browsers.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "tools/explain/live_explainer.hpp"
#include "tools/http/watch_rules.hpp"
#include "tools/preview/watch_board.hpp"

namespace lightnet {

/// What somebody who has the token wants of the run.
struct WatchCommand {
    enum class What { end, write, drain };
    What what = What::end;
    std::string host = {};  // to be drained
    /// Tells what became of it: "", or why it wasn't done. May be called by any thread.
    std::function<void(const std::string& why_not)> answer = [](const std::string&) {};
    friend bool operator==(const WatchCommand& one, const WatchCommand& other) {
        return one.what == other.what && one.host == other.host;
    }
};

/// What pages see, and whom they reach by what they say.
struct WatchStage {
    std::string hello;  // JSON: what does not change
    std::shared_ptr<WatchBoard> board;
    std::function<void(WatchCommand)> command;  // called by the server's thread
    /// How a pixel came about; the reply is a text for the page, and may come from any thread. None: nobody tells.
    std::function<void(const PixelWish&, std::function<void(std::string)> reply)> explain = {};
};

/// Where several runs are shown on one page: until the first of them begins.
WatchStage stage_before_runs();

/// HTTP and WebSocket, on a thread of its own. The run writes on the board and never waits; whoever is too slow to take
/// what changes is dropped, and so is whoever says what has no sense.
///
///   GET /        the page
///   GET /state   how the run stands, as JSON
///   GET /words   the same as /live, without pixels
///   GET /live    becomes a WebSocket, on which come: {"hello": …}, anew for each stage; then texts {"state": …} and
///                {"log": […]}, and pixels as binary frames (WatchBoard). The page may say {"do": "end" | "write" |
///                "drain" | "check", "host": …, "token": …}, and is told at once {"done": …, "allowed": …}, and when it
///                was obeyed, or couldn't be, {"obeyed": …, "why_not": ""}; {"do": "explain", "x": …, "y": …,
///                "samples": …, "token": …} is answered by {"explained": {…}} besides (LiveExplainer), and {"do":
///                "edit", "edit": {…}, "token": …} by what a session tells of it.
///
/// Whoever can connect may look; only who has the token may do something. What is called by another name than its own
/// (421), or by a page of another origin (403), is refused.
class WatchServer {
public:
    struct Options {
        WatchAddress address;
        std::string token;
        std::string_view page;  // its bytes; outlives the server
        /// An edit, as a line of JSON; called by the server's thread. None: nothing can be edited.
        std::function<void(std::string)> edit = {};
        /// Ends what goes on beyond single runs, also where none is shown; called by the server's thread. None: that is
        /// the business of the run that is shown.
        std::function<void()> end = {};
        std::uint64_t slow_seconds = 5;  // for one message to be taken
        std::size_t most_watchers = 64;
        std::size_t send_buffer = 0;  // of the system, bytes; 0: as it likes
    };
    /// Throws Error when the address can't be listened at.
    WatchServer(Options options, WatchStage stage);
    /// Says what is still to be said to those who take it at once, and ends.
    ~WatchServer();
    WatchServer(const WatchServer&) = delete;
    WatchServer& operator=(const WatchServer&) = delete;

    /// From now on pages see this; when it returns, nobody is called any more whom the last stage named. Any thread.
    /// `in_place_of`: only if that is the board that they see now; null: in any case.
    void show(WatchStage stage, const std::shared_ptr<WatchBoard>& in_place_of = nullptr);
    /// A text (JSON) for all who watch now. Any thread.
    void tell(const std::string& text);

    std::uint16_t port() const;
    /// For the user: with the token, in the part that browsers send to nobody.
    std::string url() const;
    /// Who watches now, and who was dropped for being slow. Any thread.
    std::size_t watchers() const;
    std::size_t dropped() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace lightnet
