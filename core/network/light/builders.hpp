// Those who make a value together that the places of a process share.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>

namespace lightnet {

/// Handed to the maker of Services::once(): how many they are is not its business, nor is who does what.
class Builders {
public:
    /// Is given 0, 1, … count - 1, each once. Asks nobody, and touches nothing that another piece touches.
    using Piece = std::function<void(std::size_t)>;

    virtual ~Builders() = default;
    /// Has all pieces done, in parallel where there are several builders. Returns when all have ended. Throws what one
    /// of those threw that threw anything, and then begins no more; Cancelled when nobody wants the value any more. A
    /// piece that takes more than a tenth of a second looks by itself: Services::look(). Not to be called from a piece.
    virtual void each(std::size_t count, const Piece& piece) = 0;
};

/// Does one piece after the other.
class OneBuilder final : public Builders {
public:
    /// Is told before every piece how many are done; may throw to end the work.
    using Watch = std::function<void(std::size_t done, std::size_t count)>;

    OneBuilder() = default;
    explicit OneBuilder(Watch watch) : watch_(std::move(watch)) {}
    void each(std::size_t count, const Piece& piece) override {
        for (std::size_t i = 0; i < count; ++i) {
            if (watch_) watch_(i, count);
            piece(i);
        }
    }

private:
    Watch watch_;
};

}  // namespace lightnet
