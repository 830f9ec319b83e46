// The secret by which a host proves that it belongs to a run.
#include "transport/wire/pass.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::pass_test {
namespace {

using ::testing::HasSubstr;

TEST(Pass, IsMadeOnceAndForItsUserAlone) {
    const test::Folder folder;
    const auto file = folder.file("config/lightnet/pass");
    const Pass first = Pass::of(file), again = Pass::of(file);
    const Pass::Claim claim{"onyx1", 7, ""};
    EXPECT_EQ(first.proof("c", claim), again.proof("c", claim));
    EXPECT_EQ(std::filesystem::status(file).permissions(),
              std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    EXPECT_NE(Pass::of(folder.file("another")).proof("c", claim), first.proof("c", claim));
}

TEST(Pass, IsMadeBesideWhatAnotherStartHasLeft) {
    const test::Folder folder;
    for (const int process : {1, static_cast<int>(::getpid())}) folder.write("pass." + std::to_string(process), "half");
    EXPECT_NO_THROW(Pass::of(folder.file("pass")));
    EXPECT_FALSE(std::filesystem::is_empty(folder.file("pass")));
}

// As where the disk is full: the system writes no file of more than a few bytes.
TEST(Pass, LeavesNothingOfItselfWhereItCannotBeWritten) {
    const test::Folder folder;
    const auto child = ::fork();
    if (child == 0) {
        ::signal(SIGXFSZ, SIG_IGN);
        const rlimit few{8, 8};
        ::setrlimit(RLIMIT_FSIZE, &few);
        try {
            Pass::of(folder.file("pass"));
        } catch (const Error& error) {
            ::_exit(std::string(error.what()).find("no pass can be made") == std::string::npos);
        }
        ::_exit(2);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Pass, ThatOthersCanReadIsRefused) {
    const test::Folder folder;
    const auto file = folder.write("pass", std::string(64, 'a'));
    std::filesystem::permissions(file, static_cast<std::filesystem::perms>(0640));
    try {
        Pass::of(file);
        FAIL() << "nobody noticed";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("mode 0600"));
    }
}

TEST(Pass, ThatIsNoFileOrTooShortIsRefused) {
    const test::Folder folder;
    EXPECT_THROW(Pass::of(folder.path().string()), Error);
    const auto pipe = folder.file("pipe");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THROW(Pass::of(pipe), Error) << "and nobody waits for a writer";
    const auto brief = folder.write("brief", "secret\n");
    std::filesystem::permissions(brief, static_cast<std::filesystem::perms>(0600));
    EXPECT_THROW(Pass::of(brief), Error);
}

TEST(Pass, ProvesOneClaimToOneChallengeOnly) {
    const Pass pass("a secret of thirty-two characters");
    const Pass::Claim claim{"onyx1", 7, "tcp://10.0.0.1:7777"};
    const auto proof = pass.proof("challenge", claim);
    EXPECT_TRUE(pass.proves("challenge", claim, proof));
    EXPECT_FALSE(pass.proves("another", claim, proof));
    EXPECT_FALSE(pass.proves("challenge", {"onyx2", 7, "tcp://10.0.0.1:7777"}, proof));
    EXPECT_FALSE(pass.proves("challenge", {"onyx1", 8, "tcp://10.0.0.1:7777"}, proof));
    EXPECT_FALSE(pass.proves("challenge", {"onyx1", 7, ""}, proof));
    EXPECT_FALSE(pass.proves("challenge", {"onyx17", 0, "tcp://10.0.0.1:7777"}, proof));
    EXPECT_FALSE(pass.proves("challenge", claim, ""));
    EXPECT_FALSE(Pass("another secret of other characters").proves("challenge", claim, proof));
}

}  // namespace
}  // namespace lightnet::pass_test
