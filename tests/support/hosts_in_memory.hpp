// A transport between hosts of another make: queues in memory. What another transport has to do, and no more.
#pragma once

#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "transport/lines/host_transport.hpp"
#include "transport/lines/line_error.hpp"

namespace lightnet::test {

/// All ports and lines of some hosts, which are threads of this process. Endpoints are any text. Any thread.
class HostsInMemory final : public HostTransport {
public:
    std::unique_ptr<HostLine> connect(const std::string& endpoint, const std::optional<LineKeys>&,
                                      Handshakes) override {
        return std::make_unique<Line>(all_, endpoint);
    }
    std::unique_ptr<HostPort> listen(const std::string& endpoint, std::optional<DoorKeys>) override {
        return std::make_unique<Port>(all_, endpoint);
    }
    std::size_t sent() const { return all_->sent; }

private:
    struct All {
        std::mutex mutex;
        std::map<std::string, std::shared_ptr<FrameQueue>> ports, lines;  // by endpoint, by route
        std::size_t lines_made = 0;
        std::atomic<std::size_t> sent{0};
        std::shared_ptr<FrameQueue> find(const std::map<std::string, std::shared_ptr<FrameQueue>>& in,
                                         const std::string& name) {
            const std::lock_guard lock(mutex);
            const auto found = in.find(name);
            return found == in.end() ? nullptr : found->second;
        }
    };

    class Line final : public HostLine {
    public:
        Line(std::shared_ptr<All> all, std::string endpoint) : all_(std::move(all)), endpoint_(std::move(endpoint)) {
            const std::lock_guard lock(all_->mutex);
            route_ = "line " + std::to_string(++all_->lines_made);
            all_->lines[route_] = mine_;
        }
        ~Line() override {
            const std::lock_guard lock(all_->mutex);
            all_->lines.erase(route_);
        }
        // The port greets who has found it.
        void tick(Time) override {
            if (port_) return;
            port_ = all_->find(all_->ports, endpoint_);
            auto greeting = empty_message();
            if (port_) mine_->push_always(greeting);
        }
        bool send(Frames& frames) override {
            tick({});
            if (!port_) return false;
            frames.emplace(frames.begin(), route_);
            if (port_->push(frames)) return ++all_->sent, true;
            frames.erase(frames.begin());
            return false;
        }
        std::optional<Frames> receive() override { return mine_->pop(); }
        bool can_send() const override { return port_ != nullptr; }
        void watch(Poll& poll) const override { poll.add(*mine_); }
        std::string answering_at() const override { return port_ ? endpoint_ : std::string(); }

    private:
        std::shared_ptr<All> all_;
        std::string endpoint_, route_;
        std::shared_ptr<FrameQueue> mine_ = std::make_shared<FrameQueue>(), port_;
    };

    class Port final : public HostPort {
    public:
        Port(std::shared_ptr<All> all, std::string endpoint) : all_(std::move(all)), endpoint_(std::move(endpoint)) {
            const std::lock_guard lock(all_->mutex);
            if (!all_->ports.emplace(endpoint_, mine_).second) throw Error(endpoint_, "somebody listens there");
        }
        ~Port() override {
            const std::lock_guard lock(all_->mutex);
            all_->ports.erase(endpoint_);
            mine_->close();
        }
        std::string endpoint() const override { return endpoint_; }
        std::optional<Frames> receive() override { return mine_->pop(); }
        SendResult send(Frames& frames) override {
            const auto line = all_->find(all_->lines, text_of(frames.front()));
            if (!line) return SendResult::peer_is_gone;
            auto route = std::move(frames.front());
            frames.erase(frames.begin());
            if (line->push(frames)) return ++all_->sent, SendResult::sent;
            frames.insert(frames.begin(), std::move(route));
            return SendResult::line_is_full;
        }
        void watch(Poll& poll) const override { poll.add(*mine_); }

    private:
        std::shared_ptr<All> all_;
        std::string endpoint_;
        std::shared_ptr<FrameQueue> mine_ = std::make_shared<FrameQueue>();
    };

    std::shared_ptr<All> all_ = std::make_shared<All>();
};

}  // namespace lightnet::test
