// Who may say what: the table of docs/trust.md is the table of the code.
#include "transport/wire/rights.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "transport/daemon/host_rights.hpp"

namespace lightnet::rights_test {
namespace {

using packet::Type;

const std::map<std::string, Type> types{{"ask_light", Type::ask_light},
                                        {"ask_pixels", Type::ask_pixels},
                                        {"answers", Type::answers},
                                        {"failure", Type::failure},
                                        {"ask_step", Type::ask_step},
                                        {"data", Type::data},
                                        {"hello", Type::hello},
                                        {"welcome", Type::welcome},
                                        {"refuse", Type::refuse},
                                        {"begin", Type::begin},
                                        {"need", Type::need},
                                        {"blob", Type::blob},
                                        {"blob_taken", Type::blob_taken},
                                        {"ready", Type::ready},
                                        {"broken", Type::broken},
                                        {"ping", Type::ping},
                                        {"pong", Type::pong},
                                        {"plan", Type::plan},
                                        {"end", Type::end},
                                        {"ended", Type::ended},
                                        {"leaving", Type::leaving},
                                        {"join", Type::join},
                                        {"joined", Type::joined},
                                        {"expect", Type::expect},
                                        {"lacks", Type::lacks},
                                        {"here", Type::here},
                                        {"fault", Type::fault},
                                        {"status", Type::status},
                                        {"state", Type::state},
                                        {"members", Type::members},
                                        {"fetch", Type::fetch},
                                        {"part", Type::part},
                                        {"mark", Type::mark},
                                        {"marked", Type::marked},
                                        {"unpaced", Type::unpaced}};

constexpr std::array parties{Party::launcher, Party::owner, Party::member, Party::host, Party::user};

// The cells of the rows whose first cell names packets.
std::map<std::string, std::vector<std::string>> table() {
    std::ifstream in(LIGHTNET_SOURCE_DIR "/docs/trust.md");
    std::map<std::string, std::vector<std::string>> rows;
    bool inside = false;
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("| packet | launcher | owner | member | host | user |")) inside = true;
        if (line.empty()) inside = false;
        if (!inside) continue;
        std::vector<std::string> cells;
        std::istringstream row(line);
        for (std::string cell; std::getline(row, cell, '|');) {
            const auto first = cell.find_first_not_of(' ');
            if (first != std::string::npos)
                cells.push_back(cell.substr(first, cell.find_last_not_of(' ') + 1 - first));
            else if (!cells.empty())
                cells.emplace_back();
        }
        std::istringstream names(cells.at(0));
        for (std::string name; names >> name;) {
            std::erase(name, '`');
            std::erase(name, ',');
            rows[name] = {cells.begin() + 1, cells.end()};
        }
    }
    return rows;
}

TEST(Rights, AreThoseOfTheDocument) {
    const auto rows = table();
    EXPECT_EQ(types.size(), static_cast<std::size_t>(Type::last) - static_cast<std::size_t>(Type::hello) + 7);
    for (const auto& [name, type] : types) {
        ASSERT_TRUE(rows.contains(name)) << name << " does not stand in docs/trust.md";
        const auto& cells = rows.at(name);
        ASSERT_EQ(cells.size(), parties.size()) << name;
        for (std::size_t i = 0; i < parties.size(); ++i)
            EXPECT_EQ(may(parties[i], type), cells[i] == "yes") << name << ", column " << i;
        EXPECT_FALSE(may(Party::stranger, type)) << name;
    }
}

class HostRightsTest : public ::testing::Test {
protected:
    const PublicKey owner = KeyPair::random().open, host = KeyPair::random().open, stranger = KeyPair::random().open;
    HostRights rights{owner.text(), std::nullopt};
};

TEST_F(HostRightsTest, OfALauncherGrowWhenItBeginsARun) {
    EXPECT_TRUE(rights.may(owner.text(), Type::begin, false));
    EXPECT_FALSE(rights.may(owner.text(), Type::plan, false));
    EXPECT_FALSE(rights.may(owner.text(), Type::end, true)) << "somebody else's run";
    rights.serve(owner.text());
    EXPECT_TRUE(rights.may(owner.text(), Type::plan, true));
    EXPECT_TRUE(rights.may(owner.text(), Type::ask_pixels, true));
    rights.serve({});
    EXPECT_FALSE(rights.may(owner.text(), Type::plan, true));
}

TEST_F(HostRightsTest, OfHostsLastAsLongAsTheRun) {
    EXPECT_FALSE(rights.knows(host));
    rights.serve(owner.text());
    AllowList members;
    members.add(host, "tcp://onyx1:7777");
    rights.use_members(members);
    EXPECT_TRUE(rights.knows(host));
    EXPECT_TRUE(rights.may(host.text(), Type::ask_light, true));
    EXPECT_FALSE(rights.may(host.text(), Type::plan, true));
    rights.serve({});
    EXPECT_FALSE(rights.knows(host));
    EXPECT_FALSE(rights.may(host.text(), Type::ask_light, true));
}

TEST_F(HostRightsTest, OfStrangersAreNone) {
    rights.serve(owner.text());
    for (const auto& [name, type] : types)
        for (const auto& key : {stranger.text(), std::string(), std::string("x")})
            EXPECT_FALSE(rights.may(key, type, true)) << name;
}

TEST_F(HostRightsTest, AreNotAskedForWhereThereAreNoKeys) {
    HostRights open("", std::nullopt);
    EXPECT_TRUE(open.may("", Type::plan, true));
    EXPECT_FALSE(open.asks_for_keys());
}

}  // namespace
}  // namespace lightnet::rights_test
