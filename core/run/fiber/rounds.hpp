// Work of a place that is done concurrently: a fiber for each piece that waits.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <vector>

#include "core/network/light/side_by_side.hpp"
#include "core/run/fiber/fiber.hpp"

namespace lightnet {

/// Lives on the place's thread. The fiber that calls each() works as well, and needs nobody else: further fibers are
/// started only while all that work wait, and there is room for them. So a node goes on with the one fiber that it
/// has for itself, and what its pieces wait for never depends on another round; a round ends when those pieces have
/// ended that were begun.
class Rounds final : public SideBySide {
public:
    using Wake = std::function<void(Fibers::Fiber*)>;

    /// At most `most` fibers are started beside those that call each().
    Rounds(Fibers& fibers, std::size_t most, Wake wake);
    ~Rounds() override;

    void each(const char* node, std::size_t count, std::size_t at_once, const Work& work) override;

    /// Starts one more fiber for the youngest round that wants one. False: nothing to start. From outside fibers only.
    bool start_one();

private:
    struct Round;
    void work_on(Round& round);
    void close(Round& round);
    void help(Round& round);
    Round& open(const char* node, std::size_t count, std::size_t at_once, const Work& work);

    Fibers& fibers_;
    std::size_t most_;
    Wake wake_;
    std::vector<std::unique_ptr<Round>> rounds_;  // all that were ever needed
    std::vector<Round*> idle_;
    std::vector<Round*> open_;  // with pieces that nobody has begun
    std::size_t started_ = 0;   // fibers that help now
};

}  // namespace lightnet
