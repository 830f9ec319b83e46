// Shows a picture in the viewer tev while it grows.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/film/film.hpp"
#include "tools/http/byte_line.hpp"
#include "tools/preview/watch_board.hpp"

namespace lightnet {

/// Reads the board on a thread of its own, as a page that watches does, and sends what has changed. While the viewer
/// isn't there it is called again every second, and gets all of the picture when it comes. The beauty is the channels
/// R, G and B; each layer, and each picture beside the sum, is a layer of tev's. Nobody waits for the viewer.
class TevPreview {
public:
    struct Options {
        std::string host;
        std::uint16_t port = 0;
        std::string name;  // of the picture in the viewer
        FilmFormat format;
    };
    /// The board outlives it. Throws Error when the host's name is nobody's.
    TevPreview(Options options, WatchBoard& board);
    /// Sends what is left, for a second at most.
    ~TevPreview();
    TevPreview(const TevPreview&) = delete;
    TevPreview& operator=(const TevPreview&) = delete;

    /// What there is to say of the viewer since it was last asked. Any thread.
    std::vector<std::string> news();
    /// From now on nothing changes. A file that has all of it, on the viewer's machine, takes the picture's place at
    /// the end; "": there is none.
    void finish(const std::string& file);

private:
    using Clock = std::chrono::steady_clock;

    void run();
    void call();
    void send_changes();
    void send_file();
    bool send(const std::string& bytes);
    std::string packet_of(const char*& bytes) const;
    std::string address() const;
    std::string why_none() const;
    void say(const std::string& line);
    void rest(std::chrono::milliseconds time);
    bool ends() const { return ending_; }

    Options options_;
    WatchBoard& board_;
    ByteTarget target_;
    std::vector<std::string> channels_;
    std::unique_ptr<ByteLine> line_;
    WatchBoard::Seen seen_;
    bool up_to_date_ = false, missed_ = false;
    std::atomic<bool> ending_{false};
    std::atomic<Clock::time_point> end_{Clock::time_point::max()};
    std::mutex mutex_;  // of the next three
    std::condition_variable awake_;
    std::vector<std::string> news_;
    std::string file_;
    std::thread thread_;
};

}  // namespace lightnet
