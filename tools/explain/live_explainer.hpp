// Explains pixels of a run while it goes on.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "tools/explain/pixel_account.hpp"
#include "tools/request/run_request.hpp"

namespace lightnet {

/// What somebody who watches wants to know.
struct PixelWish {
    std::uint32_t x = 0, y = 0;  // in the whole picture
    std::uint32_t samples = 64;  // the first so many
};

/// In the launcher's process, on a thread of its own that gives way to all others: the run neither waits for it nor
/// notices it, since every sample can be computed again alone. What it needs it shares with the places of this process;
/// where these have no network, it reads the scene when it is first asked. One pixel after the other.
class LiveExplainer {
public:
    /// {"explained": {"x", "y", "samples", "of", "seconds", "text", "rays"}}, or "error" in place of the last five.
    using Reply = std::function<void(std::string)>;

    /// `request` and `registry` outlive it.
    LiveExplainer(const RunRequest& request, const Registry& registry, FilmFormat format);
    /// Ends what is under way, unanswered.
    ~LiveExplainer();
    LiveExplainer(const LiveExplainer&) = delete;
    LiveExplainer& operator=(const LiveExplainer&) = delete;

    /// All that nodes prepare is there: from now on, wishes are heard. Any thread, as the next two.
    void begin();
    /// Places of this process have that; before begin().
    void share(std::shared_ptr<const Network> network, MadeFrom made_from, float scale);
    /// `reply` is called once, by this thread or the explainer's own.
    void explain(const PixelWish& wish, Reply reply);

    static constexpr std::uint32_t most_samples = 1024;

private:
    using Asked = std::pair<PixelWish, Reply>;
    void work();
    std::string answer(const PixelWish& wish);
    PixelRecount& recount();
    PixelRecount::Source source() const;
    std::string why_not(const PixelWish& wish) const;

    const RunRequest& request_;
    const Registry& registry_;
    const FilmFormat format_;
    std::atomic<bool> ends_{false};
    mutable std::mutex mutex_;  // of the next five
    std::condition_variable asked_;
    bool begun_ = false;
    std::deque<Asked> waiting_;
    std::optional<PixelRecount::Source> shared_;
    std::unique_ptr<PixelRecount> recount_;  // the thread's
    std::thread thread_;                     // from the first wish on
};

}  // namespace lightnet
