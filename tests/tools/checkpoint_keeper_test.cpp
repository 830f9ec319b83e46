// How a run keeps what it has.
#include "tools/session/checkpoint_keeper.hpp"

#include <gtest/gtest.h>

#include "tests/support/folder.hpp"

namespace lightnet::checkpoint_keeper_test {
namespace {

using namespace std::chrono_literals;

class Checkpoints : public ::testing::Test {
protected:
    void add_block(std::uint32_t block) {
        film.add({0, 0, 64, 64, block * 16, 16}, std::vector<Rgb>(64 * 64, Rgb{1, 1, 1}));
    }
    // In the file.
    double samples() const {
        Film found({64, 64, {"light"}, 160});
        found.restore(read_checkpoint(keeper.file())->film);
        return found.mean_samples();
    }
    const test::Folder folder;
    Film film{{64, 64, {"light"}, 160}};
    CheckpointKeeper keeper{film, folder / "x.exr", {}, 0s};
};

TEST_F(Checkpoints, AreNotBegunWhereTheyWouldTakeTooLong) {
    add_block(0);
    EXPECT_EQ(keeper.save_if_due(1), "");
    add_block(1);
    EXPECT_FALSE(keeper.save(2, 0s)) << "the first one took longer";
    EXPECT_EQ(samples(), 16) << "it is still there";
    EXPECT_TRUE(keeper.save(2, 1h));
    EXPECT_EQ(samples(), 32);
}

TEST_F(Checkpoints, AreBegunWhereThereIsNoOtherHoweverLongTheyTake) {
    add_block(0);
    EXPECT_TRUE(keeper.save(1, 0s));
    EXPECT_EQ(samples(), 16);
}

}  // namespace
}  // namespace lightnet::checkpoint_keeper_test
