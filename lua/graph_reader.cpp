#include "lua/graph_reader.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <exception>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/plain_file.hpp"
#include "core/base/spare_threads.hpp"
#include "lua/answer.hpp"

namespace lightnet {
namespace {

using Length = std::uint64_t;  // goes before each text

bool send_all(int socket, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
}

bool send_text(int socket, const std::string& text) {
    const Length length = text.size();
    std::array<char, sizeof length> bytes;
    std::memcpy(bytes.data(), &length, sizeof length);
    return send_all(socket, {bytes.data(), bytes.size()}) && send_all(socket, text);
}

bool receive_all(int socket, char* to, std::size_t size) {
    while (size > 0) {
        const ssize_t got = ::recv(socket, to, size, 0);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        to += got;
        size -= static_cast<std::size_t>(got);
    }
    return true;
}

// None: the other side is gone.
std::optional<std::string> receive_text(int socket) {
    Length length = 0;
    std::array<char, sizeof length> bytes;
    if (!receive_all(socket, bytes.data(), bytes.size())) return std::nullopt;
    std::memcpy(&length, bytes.data(), sizeof length);
    std::string text(length, '\0');
    if (!receive_all(socket, text.data(), text.size())) return std::nullopt;
    return text;
}

std::string pack(const std::string& file, const LuaOptions& options) {
    JsonTree constants = JsonTree::object();
    for (const auto& [name, value] : options.constants) constants[name] = tree_of_text(value);
    return to_text(JsonTree{{"file", tree_of_text(file)},
                            {"constants", std::move(constants)},
                            {"processor", options.cpu_seconds},
                            {"most", options.wall_seconds},
                            {"memory", options.memory},
                            {"frame", options.frame.number},
                            {"frames", options.frame.count},
                            {"asked", options.frame.asked}});
}

// None: it is no plain file, or larger than graphs are.
std::optional<std::string> text_now(const std::string& file) try {
    constexpr std::uint64_t most = std::uint64_t{1} << 20;
    return PlainFile(file, most).text();
} catch (const Error&) {
    return std::nullopt;
}

std::string answer_to(const std::string& question) {
    const Json json = parse_json(question);
    LuaOptions options;
    options.cpu_seconds = json.at("processor").number();
    options.wall_seconds = json.at("most").number();
    options.memory = json.at("memory").whole<std::size_t>();
    options.frame = {static_cast<int>(json.at("frame").number()), static_cast<int>(json.at("frames").number()),
                     json.at("asked").flag()};
    for (const auto& [name, value] : json.at("constants").object())
        options.constants.emplace(name, text_from_json(value));
    try {
        const GraphFile read = read_graph(text_from_json(json.at("file")), options);
        return lua::pack({to_json(read.graph), read.problems, read.alone});
    } catch (const UserError& error) {
        return lua::pack({"", error.problems(), false});
    }
}

// Terminals interrupt all processes that they show; this one ends when nobody asks it any more.
[[noreturn]] void answer_until_alone(int socket, pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) ::signal(signal, SIG_IGN);
    try {
        while (const auto question = receive_text(socket))
            if (!send_text(socket, answer_to(*question))) break;
    } catch (const std::exception&) {  // the parent says that it is gone
        ::_exit(1);
    }
    ::_exit(0);
}

}  // namespace

struct GraphReader::Child {
    pid_t id = -1;
    int socket = -1;
    ~Child() {
        if (socket >= 0) ::close(socket);
        if (id < 0) return;
        ::kill(id, SIGKILL);
        while (::waitpid(id, nullptr, 0) < 0 && errno == EINTR) {
        }
    }
};

GraphReader::GraphReader() : child_(std::make_unique<Child>()) {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        throw Error("graphs can't be read", std::string("no socket: ") + std::strerror(errno));
    child_->socket = ends[0];
    const pid_t parent = ::getpid();
    child_->id = ::fork();
    if (child_->id == 0) {
        ::close(ends[0]);
        answer_until_alone(ends[1], parent);
    }
    ::close(ends[1]);
    if (child_->id < 0)
        throw Error("graphs can't be read",
                    std::string("no process can be started: ") + std::strerror(errno) + "; " + more_threads_help);
}

GraphReader::~GraphReader() = default;

GraphFile GraphReader::read(const std::string& file, const LuaOptions& options) {
    std::string question = pack(file, options);
    const auto text = text_now(file);
    if (text && last_ && last_->question == question && last_->text == *text) return last_->read;
    last_.reset();
    std::optional<std::string> answer;
    if (send_text(child_->socket, question)) answer = receive_text(child_->socket);
    if (!answer) throw UserError({file, 0}, "can't be read: the process that evaluates graphs is gone");
    auto [graph, problems, alone] = lua::unpack(*answer);
    if (graph.empty()) throw UserError(std::move(problems));
    GraphFile read{graph_from_json(graph), std::move(problems), alone};
    // it may have been edited between the two looks at it
    if (text && alone && read.problems.empty() && text_now(file) == text) last_ = {std::move(question), *text, read};
    return read;
}

}  // namespace lightnet
