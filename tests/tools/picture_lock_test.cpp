#include "tools/pictures/picture_lock.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
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

// Else two runs would write one picture, and neither would know.
TEST(PictureLock, IsNotToBeHadWhereSomethingElseStands) {
    const test::Folder folder;
    const auto refused = [&](const std::string& picture) -> std::string {
        try {
            const PictureLock lock(folder / picture);
            return "nobody noticed";
        } catch (const UserError& error) {
            return error.what();
        }
    };
    folder.write("notes", "mine");
    folder.write(".file.exr.lock", "mine");
    std::filesystem::create_directory(folder / ".folder.exr.lock");
    std::filesystem::create_symlink(folder / "notes", folder / ".link.exr.lock");
    ASSERT_EQ(::mkfifo((folder / ".pipe.exr.lock").c_str(), 0600), 0);
    for (const std::string what : {"file", "folder", "link", "pipe"}) {
        EXPECT_THAT(refused(what + ".exr"), HasSubstr("in the way of the lock on the picture")) << what;
        EXPECT_TRUE(std::filesystem::exists(std::filesystem::symlink_status(folder / ("." + what + ".exr.lock"))));
    }
    EXPECT_EQ(std::filesystem::file_size(folder / "notes"), 4u);
    EXPECT_EQ(std::filesystem::file_size(folder / ".file.exr.lock"), 4u);
    folder.write(".empty.exr.lock", "");
    EXPECT_EQ(refused("empty.exr"), "nobody noticed") << "as one whose process was killed at once";
}

}  // namespace
}  // namespace lightnet::picture_lock_test
