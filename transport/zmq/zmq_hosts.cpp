#include "transport/zmq/zmq_hosts.hpp"

#include <utility>

#include "core/base/ip_address.hpp"
#include "transport/zmq/caller.hpp"
#include "transport/zmq/doorkeeper.hpp"

namespace lightnet {
namespace {

/// A door and who keeps it.
class ZmqPort final : public HostPort {
public:
    ZmqPort(const SocketContext& context, const std::string& endpoint, std::optional<DoorKeys> keys)
        : keeper_(context, std::move(keys)), door_(door_socket(context)) {
        keeper_.guard(door_);
        lightnet::listen(door_, context, endpoint);
        keeper_.try_out(door_);
    }
    std::string endpoint() const override { return door_.endpoint(); }
    std::optional<Frames> receive() override { return door_.receive(&sender_); }
    std::string key() const override { return sender_.key; }
    std::string address() const override {
        const auto number = ip_address(sender_.address);  // of the old family, at a port for both
        return number ? number->text() : sender_.address;
    }
    SendResult send(Frames& frames) override { return door_.try_send(frames); }
    void let_in() override { keeper_.tick(); }
    void watch(Poll& poll) const override { poll.add(door_); }
    void watch_callers(Poll& poll) const override { keeper_.watch(poll); }

private:
    Doorkeeper keeper_;
    Socket door_;
    PeerName sender_;
};

class ZmqHosts final : public HostTransport {
public:
    explicit ZmqHosts(std::shared_ptr<const SocketContext> context) : context_(std::move(context)) {}
    std::unique_ptr<HostLine> connect(const std::string& endpoint, const std::optional<LineKeys>& keys,
                                      Handshakes handshakes) override {
        return std::make_unique<Caller>(*context_, endpoint, keys, handshakes);
    }
    std::unique_ptr<HostPort> listen(const std::string& endpoint, std::optional<DoorKeys> keys) override {
        return std::make_unique<ZmqPort>(*context_, endpoint, std::move(keys));
    }

private:
    std::shared_ptr<const SocketContext> context_;
};

}  // namespace

std::shared_ptr<HostTransport> zmq_hosts(std::shared_ptr<const SocketContext> context) {
    return std::make_shared<ZmqHosts>(std::move(context));
}

}  // namespace lightnet
