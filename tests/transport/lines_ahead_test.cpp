// The next line to a host, while one is in use.
#include "transport/launcher/lines_ahead.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>

namespace lightnet::lines_ahead_test {
namespace {

using namespace std::chrono_literals;

/// Counts its lines, each of which answers by its number.
class Numbered final : public HostTransport {
public:
    class Line final : public HostLine {
    public:
        Line(Numbered& all, int number) : all_(all), number_(number) { ++all_.open; }
        ~Line() override { --all_.open; }
        bool send(Frames&) override { return true; }
        std::optional<Frames> receive() override { return std::nullopt; }
        bool can_send() const override { return all_.answers; }
        void watch(Poll&) const override {}
        std::string answering_at() const override { return std::to_string(number_); }

    private:
        Numbered& all_;
        int number_;
    };
    std::unique_ptr<HostLine> connect(const std::string&, const std::optional<LineKeys>&, Handshakes) override {
        return std::make_unique<Line>(*this, ++made);
    }
    std::unique_ptr<HostPort> listen(const std::string&, std::optional<DoorKeys>) override { return nullptr; }

    int made = 0, open = 0;
    bool answers = true;
};

TEST(LinesAhead, AreTakenByWhoeverConnectsNext) {
    const auto hosts = std::make_shared<Numbered>();
    const auto ahead = lines_ahead(hosts);
    auto line = ahead->connect("tcp://a:1", {}, Handshakes::noted);
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_EQ(line->answering_at(), "1");
    line->tick(begun);
    EXPECT_EQ(hosts->made, 1) << "what a run begins with comes first";
    line->tick(begun + 1s);
    line->tick(begun + 2s);
    EXPECT_EQ(hosts->made, 2);
    line.reset();
    EXPECT_EQ(hosts->open, 1);
    EXPECT_EQ(ahead->connect("tcp://b:1", {}, Handshakes::noted)->answering_at(), "3") << "that is another host";
    EXPECT_EQ(ahead->connect("tcp://a:1", {}, Handshakes::ignored)->answering_at(), "4");
    line = ahead->connect("tcp://a:1", {}, Handshakes::noted);
    EXPECT_EQ(line->answering_at(), "2");
    EXPECT_EQ(ahead->connect("tcp://a:1", {}, Handshakes::noted)->answering_at(), "5") << "it is taken";
}

TEST(LinesAhead, AreNotOpenedToWhoDoesNotAnswer) {
    const auto hosts = std::make_shared<Numbered>();
    hosts->answers = false;
    const auto line = lines_ahead(hosts)->connect("tcp://a:1", {}, Handshakes::noted);
    line->tick(std::chrono::steady_clock::now() + 10s);
    EXPECT_EQ(hosts->made, 1);
}

}  // namespace
}  // namespace lightnet::lines_ahead_test
