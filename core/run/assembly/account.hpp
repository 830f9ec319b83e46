// The account of a sample: every question that nodes asked for it, and every ray that they traced.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/base/query.hpp"
#include "core/network/light/port.hpp"
#include "core/scene/ray_witness.hpp"

namespace lightnet {

/// A question on an edge of the graph.
struct AskedQuestion {
    static constexpr std::size_t nobody = ~std::size_t{0};
    std::size_t asker = 0, asked = 0;  // nodes
    std::size_t within = nobody;  // the question, by index, that the asker answers with it; nobody's: the renderer's
    Query question;
    std::vector<Rgb> answer;  // a colour per layer of the edge
};

/// A ray, and what came of it.
struct TracedRay {
    std::size_t within = AskedQuestion::nobody;  // the question that was being answered
    std::size_t questions_before = 0;            // which were asked before it
    Ray ray;
    std::optional<Hit> hit;  // of one that looks for a surface
    bool looks = false;      // only asks whether anything is in its way
    bool hidden = false;     // something is
};

/// All that happened, in its order. A value.
struct Account {
    std::vector<AskedQuestion> questions;
    std::vector<TracedRay> rays;
};

/// Keeps accounts of a SerialRun, which is made with it and lives shorter. What one call asks together goes on one
/// by one while an account is kept, so that it is known which question leads to which; no answer depends on its
/// neighbours. One thread's.
class AccountKeeper {
public:
    AccountKeeper();
    ~AccountKeeper();
    AccountKeeper(const AccountKeeper&) = delete;
    AccountKeeper& operator=(const AccountKeeper&) = delete;

    /// From now on, of the calling thread.
    void begin();
    /// What happened since.
    Account end();
    bool keeps() const { return keeps_; }
    /// Asks a question on an edge, and keeps it with all that it leads to.
    void ask(std::size_t asker, std::size_t asked, Port& port, const Query& question, std::span<Rgb> answer);

private:
    class Watching;

    std::unique_ptr<Watching> watching_;
    RayWitness* before_ = nullptr;
    bool keeps_ = false;
    std::size_t within_ = AskedQuestion::nobody;
    Account account_;
};

}  // namespace lightnet
