#include "tools/picture_lock.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <optional>

#include "core/base/error.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::picture_lock_test {
namespace {

using testing::HasSubstr;

TEST(PictureLock, LetsOneRunWriteAPicture) {
    const test::Folder folder;
    std::optional<PictureLock> first(folder / "x.exr");
    try {
        const PictureLock second(folder / "x.exr");
        FAIL() << "both have it";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("x.exr: another run is writing this picture (process " +
                                            std::to_string(::getpid()) + " on "));
        EXPECT_THAT(error.what(), HasSubstr("choose another name with -o"));
    }
    const PictureLock other(folder / "y.exr");
    first.reset();
    EXPECT_NO_THROW(PictureLock(folder / "x.exr"));
}

TEST(PictureLock, LeavesNothingBehind) {
    const test::Folder folder;
    { const PictureLock lock(folder / "x.exr"); }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(PictureLock, GoesWithItsProcess) {
    const test::Folder folder;
    const pid_t child = ::fork();
    if (child == 0) {
        new PictureLock(folder / "x.exr");
        ::_exit(0);
    }
    ::waitpid(child, nullptr, 0);
    EXPECT_TRUE(std::filesystem::exists(folder / ".x.exr.lock")) << "a stale one";
    EXPECT_NO_THROW(PictureLock(folder / "x.exr"));
}

TEST(PictureLock, NeverFollowsALink) {
    const test::Folder folder;
    folder.write("notes", "mine");
    std::filesystem::create_symlink(folder / "notes", folder / ".x.exr.lock");
    { const PictureLock lock(folder / "x.exr"); }
    EXPECT_EQ(std::filesystem::file_size(folder / "notes"), 4u);
}

}  // namespace
}  // namespace lightnet::picture_lock_test
