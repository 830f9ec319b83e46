#include "tools/watch/watch_server.hpp"

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "core/base/json.hpp"
#include "core/base/json_tree.hpp"
#include "core/base/this_machine.hpp"
#include "tools/http/http_server.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_pixels = 512 << 10;  // bytes of a frame
constexpr std::size_t most_unsaid = 16;         // answers that a page hasn't taken
constexpr const char* page_policy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
    "connect-src 'self' ws: wss:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

// What all pages have in common.
struct WatchSite {
    WatchServer::Options options;
    std::shared_ptr<const WatchStage> shown;
    std::atomic<std::uint16_t> port{0};  // at which it listens
    std::string machine = machine_name();
    std::atomic<std::size_t> watchers{0};
    std::mutex stage_mutex{};  // of `shown`, while those that it names are called, too; and of the next
    std::deque<std::pair<std::uint64_t, std::string>> told{};  // the last texts for all, numbered

    std::shared_ptr<const WatchStage> stage() {
        const std::lock_guard lock(stage_mutex);
        return shown;
    }
    std::uint64_t last_told() {
        const std::lock_guard lock(stage_mutex);
        return told.empty() ? 0 : told.back().first;
    }
};

// What comes for a page from other threads, whether it is still there or not.
struct Letterbox {
    std::mutex letters_mutex;
    std::deque<std::string> letters;
};

// What a page says; null: it is no JSON.
Json understood(const std::string& text) try { return parse_json(text); } catch (const JsonError&) {
    return {};
}

// One page that watches.
class WatchingPage final : public HttpGuest {
public:
    WatchingPage(WatchSite& site, bool words_only)
        : site_(site), words_only_(words_only), stage_(site.stage()), told_(site.last_told()), texts_{stage_->hello} {
        ++site_.watchers;
    }
    ~WatchingPage() override { --site_.watchers; }
    WatchingPage(const WatchingPage&) = delete;
    WatchingPage& operator=(const WatchingPage&) = delete;

    std::optional<Message> next() override {
        if (texts_.empty()) look_at_letters();
        if (texts_.empty()) look_at_stage();
        if (texts_.empty()) look_at_board();
        if (!texts_.empty()) {
            Message message{std::move(texts_.front())};
            texts_.pop_front();
            return message;
        }
        if (words_only_) return std::nullopt;
        auto pixels = stage_->board->pixels_since(seen_, most_pixels);
        if (pixels.empty()) return std::nullopt;
        return Message{std::move(pixels), false};
    }

    bool hear(const std::string& text) override {
        const Json said = understood(text);
        const auto word = [&](const char* name) {
            const auto* found = said.has(name) ? std::get_if<std::string>(&said.at(name).data) : nullptr;
            return found ? *found : std::string();
        };
        const auto what = word("do");
        const bool known = what == "check" || what == "end" || what == "write" || what == "drain" ||
                           what == "explain" || what == "edit";
        if (!known || texts_.size() > most_unsaid) return false;
        const bool allowed = same_token(word("token"), site_.options.token);
        using What = WatchCommand::What;
        if (allowed && what == "explain")
            explain(said);
        else if (allowed && what == "edit")
            edit(said);
        else if (allowed && what != "check")
            command({what == "end"     ? What::end
                     : what == "write" ? What::write
                                       : What::drain,
                     word("host"), told_later(what)});
        texts_.push_back(sorted_text({{"done", what}, {"allowed", allowed}}));
        return true;
    }

private:
    std::function<void(const std::string&)> told_later(const std::string& what) const {
        return [box = letterbox_, what](const std::string& why_not) {
            const std::lock_guard lock(box->letters_mutex);
            box->letters.push_back(sorted_text({{"obeyed", what}, {"why_not", why_not}}));
        };
    }
    void command(WatchCommand wanted) {
        if (wanted.what == WatchCommand::What::end && site_.options.end) {
            site_.options.end();
            return wanted.answer("");
        }
        const std::lock_guard lock(site_.stage_mutex);
        site_.shown->command(std::move(wanted));
    }
    void edit(const Json& said) {
        if (site_.options.edit && said.has("edit")) site_.options.edit(to_text(JsonTree(said.at("edit"))));
    }
    // Another run is shown, or something was told to all.
    void look_at_stage() {
        const std::lock_guard lock(site_.stage_mutex);
        for (const auto& [number, text] : site_.told)
            if (number > told_) texts_.push_back(text), told_ = number;
        if (site_.shown == stage_) return;
        stage_ = site_.shown;
        stage_->board->want();
        seen_ = {};
        texts_.push_back(stage_->hello);
    }
    void look_at_letters() {
        const std::lock_guard lock(letterbox_->letters_mutex);
        std::swap(texts_, letterbox_->letters);
    }
    void explain(const Json& said) {
        const auto number = [&](const char* name, std::uint32_t usual) {
            const auto* found = said.has(name) ? std::get_if<std::uint64_t>(&said.at(name).data) : nullptr;
            return found && *found <= 0xffffffffu ? static_cast<std::uint32_t>(*found) : usual;
        };
        const std::lock_guard stage_lock(site_.stage_mutex);
        if (!site_.shown->explain) return;
        const PixelWish wish{number("x", ~0u), number("y", ~0u), number("samples", PixelWish{}.samples)};
        site_.shown->explain(wish, [box = letterbox_](std::string text) {
            const std::lock_guard lock(box->letters_mutex);
            box->letters.push_back(std::move(text));
        });
    }
    void look_at_board() {
        if (const auto lines = stage_->board->lines_since(seen_); !lines.empty())
            texts_.push_back(sorted_text({{"log", lines}}));
        if (const auto state = stage_->board->state_since(seen_); !state.empty())
            texts_.push_back("{\"state\":" + state + "}");
    }

    WatchSite& site_;
    const bool words_only_;
    std::shared_ptr<const WatchStage> stage_;
    std::uint64_t told_;  // number of the last text for all
    WatchBoard::Seen seen_;
    std::deque<std::string> texts_;
    std::shared_ptr<Letterbox> letterbox_ = std::make_shared<Letterbox>();
};

std::string state_of(WatchSite& site) {
    const auto stage = site.stage();
    stage->board->want();
    const auto now = stage->board->state();
    const auto& hello = stage->hello;  // {"hello":{…}}
    return hello.substr(0, hello.rfind('}')) + ",\"state\":" + (now.empty() ? "null" : now) + "}\n";
}

HttpAnswer live(WatchSite& site, const HttpRequest& request) {
    if (!request.upgrade) return refusal(426, std::string(request.path) + " is a WebSocket");
    if (site.watchers >= site.options.most_watchers) return refusal(503, "too many watch already");
    site.stage()->board->want();
    HttpAnswer answer;
    answer.guest = std::make_shared<WatchingPage>(site, request.path == "/words");
    return answer;
}

HttpAnswer answer(WatchSite& site, const HttpRequest& request) {
    if (request.host.empty()) return refusal(400, "a request names the host that it is for");
    if (!is_own_host(request.host, {site.options.address.host, site.port}, site.machine))
        return refusal(421, "nobody is called so here");
    if (!is_own_origin(request.origin, request.host)) return refusal(403, "pages of others get nothing here");
    if (request.path == "/live" || request.path == "/words") return live(site, request);
    if (request.path == "/") return {200, std::string(site.options.page), "text/html; charset=utf-8"};
    if (request.path == "/state") return {200, state_of(site), "application/json"};
    return refusal(404, "there is only the page, /state, /live and /words");
}

HttpServer::Options server_options(WatchSite& site) {
    HttpServer::Options options;
    options.who = "--watch";
    options.host = site.options.address.host;
    options.port = site.options.address.port;
    options.answer = [&site](const HttpRequest& request) { return answer(site, request); };
    options.headers = {
        {"X-Frame-Options", "DENY"}, {"Referrer-Policy", "no-referrer"}, {"Content-Security-Policy", page_policy}};
    options.slow_seconds = site.options.slow_seconds;
    options.send_buffer = site.options.send_buffer;
    return options;
}

}  // namespace

struct WatchServer::Parts {
    WatchSite site;  // outlives the server
    HttpServer server;

    Parts(Options given, WatchStage stage)
        : site{std::move(given), std::make_shared<const WatchStage>(std::move(stage))}, server(server_options(site)) {
        site.port = server.port();
    }
};

WatchStage stage_before_runs() {
    return {R"({"hello":null})", std::make_shared<WatchBoard>(Window{}, 1),
            [](const WatchCommand& command) { command.answer("not yet"); }};
}

WatchServer::WatchServer(Options options, WatchStage stage)
    : parts_(std::make_unique<Parts>(std::move(options), std::move(stage))) {}
WatchServer::~WatchServer() = default;

void WatchServer::show(WatchStage stage, const std::shared_ptr<WatchBoard>& in_place_of) {
    auto next = std::make_shared<const WatchStage>(std::move(stage));
    const std::lock_guard lock(parts_->site.stage_mutex);
    if (!in_place_of || parts_->site.shown->board == in_place_of) parts_->site.shown = std::move(next);
}

void WatchServer::tell(const std::string& text) {
    auto& site = parts_->site;
    const std::lock_guard lock(site.stage_mutex);
    site.told.emplace_back(site.told.empty() ? 1 : site.told.back().first + 1, text);
    if (site.told.size() > most_unsaid) site.told.pop_front();
}

std::uint16_t WatchServer::port() const { return parts_->server.port(); }
std::string WatchServer::url() const {
    return "http://" + in_url(parts_->site.options.address.host) + ":" + std::to_string(port()) + "/#" +
           parts_->site.options.token;
}
std::size_t WatchServer::watchers() const { return parts_->site.watchers; }
std::size_t WatchServer::dropped() const { return parts_->server.dropped(); }

}  // namespace lightnet
