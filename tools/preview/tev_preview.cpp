#include "tools/preview/tev_preview.hpp"

#include <chrono>
#include <cstring>
#include <utility>

#include "core/film/picture.hpp"
#include "tools/http/watch_rules.hpp"
#include "tools/preview/tev_packets.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;

constexpr auto viewer_interval = 1s;
constexpr auto board_interval = 100ms;         // at the board
constexpr auto viewer_patience = 5s;           // with a viewer that takes nothing
constexpr auto end_patience = 1s;              // when the run ends
constexpr std::size_t most_frame = 256 << 10;  // bytes

std::vector<std::string> tev_channels(const FilmFormat& format) {
    std::vector<std::string> channels{"R", "G", "B"};
    for (const std::size_t k : format.views())
        for (const char* channel : {".R", ".G", ".B"}) channels.push_back(format.name_of(k) + channel);
    return channels;
}

template <class Number>
std::uint32_t number_at(const char*& bytes) {
    Number number{};
    std::memcpy(&number, bytes, sizeof number);
    bytes += sizeof number;
    return number;
}

}  // namespace

TevPreview::TevPreview(Options options, WatchBoard& board)
    : options_(std::move(options)),
      board_(board),
      target_(options_.host, options_.port),
      channels_(tev_channels(options_.format)),
      thread_([this] { run(); }) {}

TevPreview::~TevPreview() {
    end_ = Clock::now() + end_patience;
    ending_ = true;
    awake_.notify_all();
    thread_.join();
}

std::vector<std::string> TevPreview::news() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, {});
}

void TevPreview::finish(const std::string& file) {
    const std::lock_guard lock(mutex_);
    file_ = file;
}

std::string TevPreview::address() const { return in_url(options_.host) + ":" + std::to_string(options_.port); }

std::string TevPreview::why_none() const {
    const auto trouble = target_.trouble();
    return trouble.empty() ? trouble : " (" + trouble + ")";
}

void TevPreview::say(const std::string& line) {
    const std::lock_guard lock(mutex_);
    news_.push_back(line);
}

void TevPreview::rest(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    awake_.wait_for(lock, time, [this] { return ends(); });
}

void TevPreview::run() {
    while (true) {
        const bool last = ends();  // what is on the board by now, is all
        if (line_) send_changes();
        if (last && (!line_ || up_to_date_ || Clock::now() >= end_.load())) break;
        if (!line_) call();
    }
    send_file();
}

void TevPreview::call() {
    const auto given_up = Clock::now() + viewer_patience;
    line_ = ByteLine::to(target_, [&] { return !ends() && Clock::now() < given_up; });
    if (!line_) {
        if (!std::exchange(missed_, true))
            say("no tev at " + address() + " so far" + why_none() + "; it is called again every second");
        return rest(viewer_interval);
    }
    missed_ = false;
    seen_ = {};
    up_to_date_ = false;
    board_.want();
    if (send(tev_create_image(options_.name, board_.window(), channels_)))
        say("tev at " + address() + " shows the picture");
}

void TevPreview::send_changes() {
    const auto frame = board_.pixels_since(seen_, most_frame);
    up_to_date_ = frame.empty();
    if (up_to_date_) {
        if (!send("")) return;  // sees whether it is still there
        return rest(board_interval);
    }
    const char* bytes = frame.data();
    for (auto left = number_at<std::uint32_t>(bytes); left > 0; --left)
        if (!send(packet_of(bytes))) return;
}

// A rectangle of a frame, which is then behind `bytes`.
std::string TevPreview::packet_of(const char*& bytes) const {
    Window where;
    for (auto* number : {&where.x, &where.y, &where.width, &where.height}) *number = number_at<std::uint16_t>(bytes);
    const auto& format = options_.format;
    const std::size_t pixels = where.pixels(), colours = board_.colours();
    std::vector<Rgb> given(pixels * colours);
    std::memcpy(given.data(), bytes, given.size() * sizeof(Rgb));
    bytes += given.size() * sizeof(Rgb);

    Picture part;
    part.width = where.width, part.height = where.height;
    for (std::size_t k = 0; k < format.layers.size(); ++k) {
        auto& layer = part.layers.emplace_back();
        if (k < format.gains.size()) layer.gain = format.gains[k];
        for (std::size_t i = 0; i < pixels; ++i) layer.pixels.push_back(given[i * colours + k]);
    }
    make_beauty(part);
    std::vector<float> values;
    values.reserve(pixels * channels_.size());
    const auto add = [&](const Rgb& colour) { values.insert(values.end(), {colour.r, colour.g, colour.b}); };
    for (std::size_t i = 0; i < pixels; ++i) {
        add(part.beauty[i]);
        for (std::size_t k = 0; k < format.views().size(); ++k) add(given[i * colours + k]);
    }
    return tev_update_image(options_.name, channels_, where, values);
}

// The file has all that pixels have, and what they have not: attributes, and exact sums of what came last.
void TevPreview::send_file() {
    std::string file;
    {
        const std::lock_guard lock(mutex_);
        file = file_;
    }
    // What stands behind a colon would be taken for names of channels.
    if (!line_ || file.empty() || file.find(':') != std::string::npos) return;
    if (send(tev_close_image(options_.name))) send(tev_open_image(file));
}

bool TevPreview::send(const std::string& bytes) {
    const auto given_up = Clock::now() + viewer_patience;
    const bool open = line_->is_open();
    if (open && line_->send(bytes, [&] { return Clock::now() < std::min(given_up, end_.load()); })) return true;
    line_.reset();
    say("tev at " + address() + (open ? " takes nothing any more" : " has gone") + "; it is called again");
    return false;
}

}  // namespace lightnet
