// The id of this process, kept.
#include "transport/zmq/process_id.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

namespace lightnet {
namespace {

pid_t id_by_the_system() { return static_cast<pid_t>(syscall(SYS_getpid)); }

// What a child finds, told by the code that it ends with.
template <class Work>
int code_of_child(const Work& work) {
    const pid_t child = fork();
    if (child == 0) _exit(work());
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(ProcessId, IsThatOfTheSystem) {
    keep_process_id();
    keep_process_id();
    EXPECT_EQ(getpid(), id_by_the_system());
}

TEST(ProcessId, IsAnotherInAForkedProcess) {
    keep_process_id();
    const pid_t parent = getpid();
    const auto right = [&] { return getpid() != parent && getpid() == id_by_the_system(); };
    EXPECT_EQ(code_of_child([&] { return right() ? code_of_child([&] { return right() ? 7 : 1; }) : 2; }), 7);
}

// A library finds what the whole program has.
TEST(ProcessId, IsAskedOfUsByLibraries) {
    Dl_info ours{}, theirs{};
    ASSERT_NE(dladdr(reinterpret_cast<const void*>(&keep_process_id), &ours), 0);
    ASSERT_NE(dladdr(dlsym(RTLD_DEFAULT, "getpid"), &theirs), 0);
    EXPECT_EQ(std::string(theirs.dli_fname), ours.dli_fname);
}

}  // namespace
}  // namespace lightnet
