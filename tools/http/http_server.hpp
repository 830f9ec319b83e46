// A small server of HTTP and WebSocket, for pages and figures that somebody may look at while others work.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace lightnet {

/// What somebody asks, by GET or HEAD. Valid while it is answered.
struct HttpRequest {
    std::string_view path;          // without what stands behind a "?"
    std::string_view host, origin;  // "": it doesn't say
    bool upgrade = false;           // to a WebSocket
};

/// What is told by a WebSocket, to its other end and from there. Called by the server's thread, and destroyed by it.
class HttpGuest {
public:
    struct Message {
        std::string data;
        bool text = true;  // else bytes
    };
    virtual ~HttpGuest() = default;
    /// What is to be sent next; none: nothing, for now.
    virtual std::optional<Message> next() = 0;
    /// What the other end says. False: it has no sense, and who says it is dropped.
    virtual bool hear(const std::string& text) = 0;
};

struct HttpAnswer {
    int status = 200;
    std::string body;
    std::string type = "text/plain; charset=utf-8";
    std::shared_ptr<HttpGuest> guest = nullptr;  // instead of a body: the connection becomes its WebSocket
};
HttpAnswer refusal(int status, const std::string& why);

/// Answers on a thread of its own. A request must be whole within five seconds and 8 KiB, has no body, and is answered
/// alone; all but GET and HEAD get a 4xx. Who doesn't take what is sent is dropped, never waited for.
class HttpServer {
public:
    struct Options {
        std::string who;                                       // is listening, for errors: "--watch"
        std::string host = "127.0.0.1";                        // an address of numbers
        std::uint16_t port = 0;                                // 0: one that is free
        std::function<HttpAnswer(const HttpRequest&)> answer;  // called by the server's thread
        std::map<std::string, std::string> headers = {};       // of each answer
        std::size_t most_connections = 256;                    // more are closed at once
        std::uint64_t slow_seconds = 5;                        // for one message of a WebSocket to be taken
        std::size_t send_buffer = 0;  // of the system for each WebSocket, bytes; 0: as it likes
    };
    /// Throws Error when the address can't be listened at.
    explicit HttpServer(Options options);
    /// Sends what guests still have to say to those who take it at once (half a second), and ends.
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    std::uint16_t port() const;
    /// WebSockets that were dropped for being slow. Any thread.
    std::size_t dropped() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace lightnet
