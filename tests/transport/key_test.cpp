// Keys, where they lie, and lists of them.
#include "transport/keys/key.hpp"

#include <gmock/gmock.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "core/base/error.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/slowdown.hpp"
#include "transport/keys/allow_list.hpp"
#include "transport/keys/key_file.hpp"
#include "transport/keys/mac.hpp"

namespace lightnet::key_test {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

template <class Act>
std::string error_of(Act act) {
    try {
        act();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "nobody noticed";
}

TEST(Key, IsReadBackFromItsText) {
    const auto pair = KeyPair::random();
    EXPECT_EQ(PublicKey::from(pair.open.text()), pair.open);
    EXPECT_EQ(KeyPair::from_secret(pair.secret_text())->open, pair.open);
    EXPECT_NE(KeyPair::random().open, pair.open);
    EXPECT_EQ(pair.open.text().find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_"),
              std::string::npos)
        << "no shell and no Lua takes any of it for its own";
}

TEST(Key, ThatIsMistypedAnywhereIsNoticed) {
    const auto text = KeyPair::random().open.text();
    for (std::size_t i = 0; i < text.size(); ++i) {
        auto wrong = text;
        wrong[i] = wrong[i] == 'x' ? 'y' : 'x';
        EXPECT_FALSE(PublicKey::from(wrong)) << i;
        EXPECT_THAT(mistake_in_key(wrong), HasSubstr("mistyped"));
    }
    EXPECT_THAT(mistake_in_key(text.substr(1)), HasSubstr("48 letters, not 47"));
    EXPECT_THAT(mistake_in_key(text), IsEmpty());
}

TEST(Key, OfOneKindIsNotTakenForTheOther) {
    const auto pair = KeyPair::random();
    EXPECT_FALSE(PublicKey::from(pair.secret_text().substr(std::string("secret-").size())));
    EXPECT_THAT(mistake_in_key(pair.secret_text()), HasSubstr("secret key, which nobody else may see"));
    EXPECT_FALSE(KeyPair::from_secret("secret-" + pair.open.text()));
}

TEST(Key, HasAFingerprintThatTellsItFromOthers) {
    std::set<std::string> prints;
    for (int i = 0; i < 1000; ++i) prints.insert(KeyPair::random().open.fingerprint());
    EXPECT_EQ(prints.size(), 1000u);
    EXPECT_EQ(prints.begin()->size(), 19u);
}

TEST(KeyFile, IsMadeOnceAndForItsUserAlone) {
    const test::Folder folder;
    const auto file = folder.file("config/lightnet/key");
    EXPECT_THAT(error_of([&] { load_key(file); }), HasSubstr("there is no key yet; lightnet key --key"));
    const auto made = load_or_make_key(file);
    EXPECT_EQ(load_or_make_key(file).open, made.open) << "never overwritten";
    EXPECT_EQ(load_key(file).secret, made.secret);
    EXPECT_EQ(std::filesystem::status(file).permissions(),
              std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "config/lightnet"), {}), 1)
        << "nothing is left beside it";
}

TEST(KeyFile, IsMadeBesideWhatAnotherStartHasLeft) {
    const test::Folder folder;
    for (const int process : {1, static_cast<int>(::getpid())})
        folder.write("key." + std::to_string(process), "half of one");
    EXPECT_FALSE(load_or_make_key(folder / "key").open.text().empty());
    std::size_t files = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder.path())) files += file.is_regular_file();
    EXPECT_EQ(files, 3u) << "and it leaves nothing itself";
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which look into their process by another one
TEST(KeyFile, IsInNoCoreDumpOfWhoHasReadIt) {
    const test::Folder folder;
    const auto child = ::fork();
    if (child == 0) {
        ::prctl(PR_SET_DUMPABLE, 1, 0, 0, 0);
        load_or_make_key(folder / "key");
        rlimit core{1, 1};
        ::getrlimit(RLIMIT_CORE, &core);
        ::_exit(::prctl(PR_GET_DUMPABLE) == 0 && core.rlim_cur == 0 && core.rlim_max == 0 ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
}
#endif

TEST(KeyFile, ThatOthersCanReadOrThatHoldsNoneIsRefused) {
    const test::Folder folder;
    const auto file = folder.file("key");
    load_or_make_key(file);
    std::filesystem::permissions(file, static_cast<std::filesystem::perms>(0640));
    EXPECT_THAT(error_of([&] { load_key(file); }), HasSubstr("mode 0600"));
    const auto junk = folder.write("junk", "not a key\n");
    std::filesystem::permissions(junk, static_cast<std::filesystem::perms>(0600));
    EXPECT_THAT(error_of([&] { load_or_make_key(junk); }), HasSubstr("there is no key in it"));
    EXPECT_EQ(std::filesystem::file_size(junk), 10u) << "and what it is stays what it was";
    const auto pipe = folder.file("pipe");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THAT(error_of([&] { load_key(pipe); }), HasSubstr("file of yours")) << "and nobody waits for a writer";
}

TEST(AllowList, TakesOneKeyALineAndItsName) {
    const auto one = KeyPair::random().open, two = KeyPair::random().open;
    const auto list = AllowList::parse(
        "# who may\n\n" + one.text() + "  anna@onyx1  # since May\r\n" + two.text() + "\tslurm-*\n", "keys");
    EXPECT_EQ(list.name_of(one), "anna@onyx1");
    EXPECT_EQ(list.key_of("slurm-*"), two);
    EXPECT_FALSE(list.name_of(KeyPair::random().open));
    EXPECT_EQ(AllowList::parse(list.text(), "keys"), list);
}

TEST(AllowList, NamesAllThatIsWrongAtOnce) {
    const auto key = KeyPair::random().open.text();
    const auto said = error_of([&] {
        AllowList::parse(key + "\nabc bert\n" + key + " carl\n" + key + " dora\n" + KeyPair::random().secret_text() +
                             " emil\n" + KeyPair::random().open.text() + " two words\n",
                         "keys");
    });
    for (const auto* problem :
         {"keys:1: the name of its owner is missing", "keys:2: a key has 48 letters, not 3",
          "keys:4: this key stands here twice", "keys:5: this is a secret key", "keys:6: a name is one word"})
        EXPECT_THAT(said, HasSubstr(problem));
}

TEST(AllowList, GivesTheNameAndNotWhoeverHasTheKey) {
    EXPECT_EQ(called("onyx1", "onyx2"), "onyx1");
    EXPECT_EQ(called("slurm-*", "slurm-7-1"), "slurm-7-1");
    EXPECT_EQ(called("slurm-*", "onyx1"), "slurm-");
}

class AllowFileTest : public ::testing::Test {
protected:
    // Looks until the list is another one.
    bool changes(AllowFile& allowed) {
        for (int look = 0; look < 10; ++look)
            if (allowed.refresh(now += milliseconds(250), [this](const std::string& text) { said += text; }))
                return true;
        return false;
    }
    test::Folder folder;
    PublicKey one = KeyPair::random().open, two = KeyPair::random().open;
    std::string file = folder.write("keys", one.text() + " one\n");
    std::chrono::steady_clock::time_point now{std::chrono::hours(1)};
    std::string said;
};

TEST_F(AllowFileTest, IsReadAgainWhenItChanges) {
    AllowFile allowed(file);
    EXPECT_FALSE(changes(allowed));
    folder.write("keys", one.text() + " one\n" + two.text() + " two\n");
    EXPECT_TRUE(changes(allowed));
    EXPECT_TRUE(allowed.list().has(two));
    std::filesystem::remove(file);
    EXPECT_TRUE(changes(allowed));
    EXPECT_TRUE(allowed.list().empty());
    EXPECT_THAT(said, HasSubstr("until it is mended nobody is let in"));
    folder.write("keys", two.text() + " two\n");
    EXPECT_TRUE(changes(allowed));
    EXPECT_FALSE(allowed.list().has(one));
}

TEST_F(AllowFileTest, ThatOthersCanWriteLetsNobodyIn) {
    std::filesystem::permissions(file, static_cast<std::filesystem::perms>(0622));
    EXPECT_THAT(error_of([&] { AllowFile{file}; }), HasSubstr("others can change this list"));
    EXPECT_THAT(error_of([&] { AllowFile{folder.file("none")}; }), HasSubstr("can't be read"));
}

TEST_F(AllowFileTest, ThatOthersCanWriteFromNowOnLetsNobodyInAtOnce) {
    AllowFile allowed(file);
    EXPECT_FALSE(changes(allowed));
    std::filesystem::permissions(file, static_cast<std::filesystem::perms>(0666));
    EXPECT_TRUE(allowed.refresh(now += milliseconds(250), [this](const std::string& text) { said += text; }));
    EXPECT_TRUE(allowed.list().empty());
    EXPECT_THAT(said, HasSubstr("others can change this list of keys"));
    std::filesystem::permissions(file, static_cast<std::filesystem::perms>(0600));
    EXPECT_TRUE(changes(allowed)) << "it was mended";
    EXPECT_TRUE(allowed.list().has(one));
}

TEST_F(AllowFileTest, MayBeOneKey) {
    AllowFile allowed(two.text());
    EXPECT_TRUE(allowed.list().has(two));
    EXPECT_FALSE(changes(allowed));
}

TEST(Mac, FitsWhatItWasMadeOfAndNothingElse) {
    const Mac mac, another;
    const auto tag = mac.tag("who asks whom");
    EXPECT_TRUE(mac.fits("who asks whom", tag));
    EXPECT_FALSE(mac.fits("who asks me", tag));
    EXPECT_FALSE(another.fits("who asks whom", tag));
    EXPECT_FALSE(mac.fits("who asks whom", tag.substr(1)));
    EXPECT_FALSE(mac.fits("who asks whom", ""));
}

}  // namespace
}  // namespace lightnet::key_test
