#include "tools/preview/watch_board.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <utility>

namespace lightnet {
namespace {

static_assert(std::endian::native == std::endian::little, "pixels go to the page as they lie in memory");

template <class Number>
void append_number(std::string& frame, std::size_t value) {
    const auto number = static_cast<Number>(value);
    frame.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace

WatchBoard::WatchBoard(const Window& window, std::size_t colours) : window_(window), colours_(colours) {}

Window WatchBoard::square(std::size_t index) const {
    const auto x = static_cast<std::uint32_t>(index % squares_across()) * square_size;
    const auto y = static_cast<std::uint32_t>(index / squares_across()) * square_size;
    return {x, y, std::min(square_size, window_.width - x), std::min(square_size, window_.height - y)};
}

bool WatchBoard::show(const Tile& tile, std::span<const Rgb> pixels) {
    const std::unique_lock lock(board_mutex_, std::try_to_lock);
    if (!lock) return false;
    if (pixels_.empty()) {
        pixels_.resize(window_.pixels() * colours_);
        const std::size_t down = (window_.height + square_size - 1) / square_size;
        changed_.resize(squares_across() * down);
    }
    const auto left = std::max(tile.x, window_.x), top = std::max(tile.y, window_.y);
    const auto right = std::min(tile.x + tile.width, window_.x + window_.width);
    const auto bottom = std::min(tile.y + tile.height, window_.y + window_.height);
    if (left >= right || top >= bottom) return true;
    for (auto y = top; y < bottom; ++y) {
        const auto from = (std::size_t{y - tile.y} * tile.width + (left - tile.x)) * colours_;
        const auto to = (std::size_t{y - window_.y} * window_.width + (left - window_.x)) * colours_;
        std::copy_n(pixels.begin() + std::ptrdiff_t(from), (right - left) * colours_,
                    pixels_.begin() + std::ptrdiff_t(to));
    }
    ++picture_;
    for (auto y = (top - window_.y) / square_size; y <= (bottom - 1 - window_.y) / square_size; ++y)
        for (auto x = (left - window_.x) / square_size; x <= (right - 1 - window_.x) / square_size; ++x)
            changed_[y * squares_across() + x] = picture_;
    return true;
}

bool WatchBoard::tell(std::string state) {
    const std::unique_lock lock(board_mutex_, std::try_to_lock);
    if (!lock) return false;
    state_ = std::move(state);
    ++state_version_;
    pin_lines();
    return true;
}

void WatchBoard::say(std::string line) {
    unpinned_.push_back(std::move(line));
    const std::unique_lock lock(board_mutex_, std::try_to_lock);
    if (lock) pin_lines();
}

void WatchBoard::pin_lines() {
    std::move(unpinned_.begin(), unpinned_.end(), std::back_inserter(lines_));
    unpinned_.clear();
    if (lines_.size() <= most_lines) return;
    const std::size_t more = lines_.size() - most_lines / 2;
    lines_.erase(lines_.begin(), lines_.begin() + std::ptrdiff_t(more));
    forgotten_ += more;
}

void WatchBoard::append(std::string& frame, const Window& part) const {
    for (const std::size_t number : {part.x, part.y, part.width, part.height})
        append_number<std::uint16_t>(frame, number);
    for (std::uint32_t y = part.y; y < part.y + part.height; ++y) {
        const Rgb* row = &pixels_[(std::size_t{y} * window_.width + part.x) * colours_];
        frame.append(reinterpret_cast<const char*>(row), part.width * colours_ * sizeof(Rgb));
    }
}

// Round by round over all squares, so that none waits for ever where they change faster than one reader takes them.
// What changes in the middle of a round is seen in it or in the next.
std::string WatchBoard::pixels_since(Seen& seen, std::size_t most_bytes) const {
    const std::lock_guard lock(board_mutex_);
    if (seen.square == 0 && std::exchange(seen.round, picture_) == picture_ && seen.picture == picture_) return {};
    std::string frame(sizeof(std::uint32_t), '\0');
    std::uint32_t count = 0;
    while (seen.square < changed_.size() && (count == 0 || frame.size() < most_bytes)) {
        const std::size_t index = seen.square++;
        if (changed_[index] <= seen.picture) continue;
        append(frame, square(index));
        ++count;
    }
    if (seen.square == changed_.size()) seen.picture = seen.round, seen.square = 0;
    std::memcpy(frame.data(), &count, sizeof count);
    return count ? frame : std::string();
}

std::string WatchBoard::state_since(Seen& seen) const {
    const std::lock_guard lock(board_mutex_);
    if (std::exchange(seen.state, state_version_) == state_version_) return {};
    return state_;
}

std::vector<std::string> WatchBoard::lines_since(Seen& seen) const {
    const std::lock_guard lock(board_mutex_);
    const std::size_t first = std::max(seen.lines, forgotten_) - forgotten_;
    seen.lines = forgotten_ + lines_.size();
    return {lines_.begin() + std::ptrdiff_t(first), lines_.end()};
}

std::string WatchBoard::state() const {
    const std::lock_guard lock(board_mutex_);
    return state_;
}

}  // namespace lightnet
