#include "tools/session/edit_queue.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr int signal_period = 20;                            // ms between two looks at the user's signals
constexpr std::size_t longest_line = std::size_t{16} << 20;  // bytes

int opened(int descriptor, const char* what) {
    if (descriptor < 0) throw Error("a session can't begin", std::string(what) + ": " + std::strerror(errno));
    return descriptor;
}

// Names of one file are one text.
std::string absolute(const std::string& file) { return fs::absolute(file).lexically_normal().string(); }

}  // namespace

EditQueue::EditQueue(int in)
    : in_(in),
      changes_(opened(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK), "no watch of files")),
      wake_(opened(::eventfd(0, EFD_CLOEXEC), "no event")),
      thread_([this] { listen(); }) {}

EditQueue::~EditQueue() {
    {
        const std::lock_guard lock(news_mutex_);
        last_words_ = true;
    }
    const std::uint64_t once = 1;
    [[maybe_unused]] const auto told = ::write(wake_, &once, sizeof once);
    thread_.join();
    ::close(changes_);
    ::close(wake_);
}

// Editors replace files, so folders are watched.
void EditQueue::watch(const std::set<std::string>& files) {
    const std::lock_guard lock(news_mutex_);
    files_.clear();
    std::map<std::string, int> before = std::exchange(folders_, {});
    for (const auto& file : files) {
        files_.insert(absolute(file));
        const auto folder = fs::path(absolute(file)).parent_path().string();
        const auto known = before.find(folder);
        if (known != before.end()) {
            folders_.insert(before.extract(known));
        } else if (!folders_.contains(folder)) {
            const int watched = ::inotify_add_watch(changes_, folder.c_str(), IN_CLOSE_WRITE | IN_MOVED_TO);
            if (watched >= 0) folders_.emplace(folder, watched);
        }
    }
    for (const auto& [folder, watched] : before) ::inotify_rm_watch(changes_, watched);
}

EditQueue::News EditQueue::take() {
    const std::lock_guard lock(news_mutex_);
    signals_.superseded = false;
    signals_.any = signals_.interrupted || signals_.terminated;
    return std::exchange(news_, News{});
}

void EditQueue::wait() {
    std::unique_lock lock(news_mutex_);
    came_.wait(lock, [this] { return something() || signals_.any; });
}

void EditQueue::add(std::string line) {
    const std::lock_guard lock(news_mutex_);
    news_.lines.push_back(std::move(line));
    supersede();
    came_.notify_one();
}

void EditQueue::supersede() {
    if (!news_.since) news_.since = std::chrono::steady_clock::now();
    signals_.superseded = true;
    signals_.any = true;
}

void EditQueue::listen() {
    std::array<pollfd, 3> ready{pollfd{in_, POLLIN, 0}, pollfd{changes_, POLLIN, 0}, pollfd{wake_, POLLIN, 0}};
    while (true) {
        ::poll(ready.data(), ready.size(), signal_period);
        if (ready[0].revents && !read_lines()) ready[0].fd = -1;  // poll() looks at it no more
        if (ready[1].revents) read_changes();
        pass_on_signals();
        const std::lock_guard lock(news_mutex_);
        if (last_words_) return;
    }
}

// False: no more will come.
bool EditQueue::read_lines() {
    std::array<char, 65536> buffer;
    const ssize_t size = ::read(in_, buffer.data(), buffer.size());
    if (size < 0 && (errno == EINTR || errno == EAGAIN)) return true;
    const bool ends = size <= 0;
    if (!ends) rest_.append(buffer.data(), static_cast<std::size_t>(size));
    if (ends && !rest_.empty()) rest_ += '\n';
    const std::lock_guard lock(news_mutex_);
    for (auto end = rest_.find('\n'); end != std::string::npos; end = rest_.find('\n')) {
        if (rest_.find_first_not_of(" \t\r\n") < end) news_.lines.push_back(rest_.substr(0, end)), supersede();
        rest_.erase(0, end + 1);
    }
    news_.ended = ends || rest_.size() > longest_line;
    came_.notify_one();
    return !news_.ended;
}

void EditQueue::read_changes() {
    alignas(inotify_event) std::array<char, 16384> buffer;
    const ssize_t size = ::read(changes_, buffer.data(), buffer.size());
    const std::lock_guard lock(news_mutex_);
    for (ssize_t at = 0; at + ssize_t(sizeof(inotify_event)) <= size;) {
        inotify_event event;
        std::memcpy(&event, buffer.data() + at, sizeof event);
        const std::string name = event.len ? buffer.data() + at + sizeof event : "";
        at += ssize_t(sizeof event + event.len);
        for (const auto& [folder, watched] : folders_) {
            const auto file = (fs::path(folder) / name).string();
            if (watched != event.wd || !files_.contains(file)) continue;
            news_.files.insert(file);
            supersede();
            came_.notify_one();
        }
    }
}

void EditQueue::pass_on_signals() {
    const Signals& users = watch_signals();
    if (!users.any) return;
    signals_.interrupted = users.interrupted.load();
    signals_.terminated = users.terminated.load();
    signals_.came = users.came.load();
    const std::lock_guard lock(news_mutex_);
    signals_.any = true;
    came_.notify_one();
}

}  // namespace lightnet
