// Those who make a value together that the places of a process share.
#pragma once

#include <cstddef>
#include <functional>

namespace lightnet {

/// Handed to the maker of Services::once(): how many they are is not its business, nor is who does what.
class Builders {
public:
    /// Is given 0, 1, … count - 1, each once. Asks nobody, and touches nothing that another piece touches.
    using Piece = std::function<void(std::size_t)>;

    virtual ~Builders() = default;
    /// Has all pieces done, in parallel where there are several builders. Returns when all have ended. Throws what one
    /// of those threw that threw anything, and then begins no more. Not to be called from a piece.
    virtual void each(std::size_t count, const Piece& piece) = 0;
};

/// Does one piece after the other.
class OneBuilder final : public Builders {
public:
    void each(std::size_t count, const Piece& piece) override {
        for (std::size_t i = 0; i < count; ++i) piece(i);
    }
};

}  // namespace lightnet
