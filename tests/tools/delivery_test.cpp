// A finished picture gets to a disk.
#include "tools/session/delivery.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::delivery_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class DeliveryTest : public ::testing::Test {
protected:
    DeliveryTest() {
        delivery.write = [this](const std::string& target) {
            ++attempts;
            if (fs::path(target).parent_path() == full.path() && attempts <= refused)
                throw Error(target, "no space left");
            std::ofstream file(target);
            if (!(file << "a picture")) throw Error(target, "can't be written");
        };
        delivery.say = [this](const std::string& text) { said += text + "\n"; };
        delivery.patience = std::chrono::seconds(0);
    }
    test::Folder full, temporary, home;
    std::string picture = full / "x.exr", said;
    Delivery delivery;
    int attempts = 0, refused = 1000;
};

TEST_F(DeliveryTest, WritesWhereItIsAskedToWithoutAWord) {
    refused = 0;
    EXPECT_EQ(deliver(delivery, picture), picture);
    EXPECT_EQ(attempts, 1);
    EXPECT_THAT(said, IsEmpty());
}

TEST_F(DeliveryTest, TriesAgainWhileThereIsPatience) {
    refused = 2;
    delivery.patience = std::chrono::seconds(30);
    EXPECT_EQ(deliver(delivery, picture), picture);
    EXPECT_EQ(attempts, 3);
    EXPECT_THAT(said, HasSubstr("no space left; trying again for 30 s"));
}

TEST_F(DeliveryTest, HasNoPatienceWhenItIsToldToStop) {
    delivery.patience = std::chrono::hours(1);
    delivery.hurried = [] { return true; };
    delivery.elsewhere = {temporary.path()};
    EXPECT_THAT(deliver(delivery, picture), StartsWith(temporary.path()));
}

TEST_F(DeliveryTest, PutsThePictureIntoTheFirstFolderThatTakesIt) {
    delivery.elsewhere = {(full / "none").string(), home.path()};
    const auto where = deliver(delivery, picture);
    EXPECT_THAT(where, StartsWith((home / "lightnet-").string()));
    EXPECT_EQ(fs::path(where).filename(), "x.exr");
    EXPECT_TRUE(fs::exists(where));
    EXPECT_THAT(said, HasSubstr("it is in " + where));
}

TEST_F(DeliveryTest, LeavesNoFolderBehindThatTookNothing) {
    delivery.write = [&](const std::string& file) {
        if (!file.starts_with(home.path().string())) throw Error(file, "no space left");
        std::ofstream(file) << "a picture";
    };
    delivery.elsewhere = {temporary.path(), home.path()};
    EXPECT_THAT(deliver(delivery, picture), StartsWith(home.path()));
    EXPECT_TRUE(fs::is_empty(temporary.path()));
}

TEST_F(DeliveryTest, SaysWhyWhenNobodyTakesIt) {
    delivery.elsewhere = {(full / "none").string()};
    try {
        deliver(delivery, picture);
        FAIL() << "it is nowhere";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("x.exr: no space left"));
        EXPECT_THAT(error.what(), HasSubstr("nor anywhere else"));
    }
}

TEST(Delivery, LooksForAFolderOfTheUsersFirst) {
    const test::Folder own;
    const char* const before = std::getenv("TMPDIR");
    const std::string kept = before ? before : "";
    ::setenv("TMPDIR", own.path().c_str(), 1);
    EXPECT_EQ(folders_of_last_resort().at(0), own.path());
    ::unsetenv("TMPDIR");
    EXPECT_EQ(folders_of_last_resort().at(0), "/tmp");
    EXPECT_EQ(folders_of_last_resort().size(), 2u) << "and the home folder";
    if (before) ::setenv("TMPDIR", kept.c_str(), 1);
}

}  // namespace
}  // namespace lightnet::delivery_test
