// Edits of a session: those that hold, and those that change nothing.
#include "tools/session/edits_in_force.hpp"

#include <gtest/gtest.h>

#include <string>

#include "core/base/error.hpp"

namespace lightnet::edits_in_force_test {
namespace {

Edit scene(const std::string& file) {
    Edit edit;
    edit.scene = file;
    return edit;
}

class EditsInForceTest : public ::testing::Test {
protected:
    EditsInForceTest()
        : edits([this](const GraphEdits& wanted) {
              ++reads;
              if (files_at_fault || wanted.scene == "wrong") throw UserError({"g.lua", 1}, "it can't be read");
              RunRequest request;
              request.scene = wanted.scene;
              return request;
          }) {}

    std::string now() { return edits.request().scene; }

    int reads = 0;
    bool files_at_fault = false;
    EditsInForce edits;
};

TEST_F(EditsInForceTest, AreThoseThatCanBeMade) {
    edits.shown();
    edits.take(scene("a"));
    EXPECT_EQ(now(), "a");
    EXPECT_EQ(reads, 1) << "what was read for a look is the run's";
    EXPECT_THROW(edits.take(scene("wrong")), UserError);
    edits.refuse();
    EXPECT_TRUE(edits.refused());
    EXPECT_EQ(now(), "a");
    edits.take(scene("b"));
    EXPECT_FALSE(edits.refused());
    EXPECT_EQ(now(), "b");
}

TEST_F(EditsInForceTest, AreTakenBackOneByOneUntilSomethingIsShown) {
    edits.take(scene("shown"));
    edits.shown();
    edits.set_finished(true);
    edits.take(scene("a"));
    EXPECT_FALSE(edits.finished());
    edits.take(scene("b"));
    EXPECT_TRUE(edits.take_back());
    EXPECT_FALSE(edits.finished());
    EXPECT_EQ(now(), "a");
    EXPECT_TRUE(edits.take_back());
    EXPECT_TRUE(edits.finished()) << "its picture is there";
    EXPECT_EQ(now(), "shown");
    EXPECT_FALSE(edits.take_back());
}

TEST_F(EditsInForceTest, HoldWhereAFileIsAtFault) {
    edits.shown();
    files_at_fault = true;
    EXPECT_NO_THROW(edits.take(scene("a"))) << "nobody has told of the file yet";
    EXPECT_THROW(edits.request(), UserError);
    EXPECT_FALSE(edits.take_back());
    EXPECT_NO_THROW(edits.take(scene("b")));
    files_at_fault = false;
    edits.forget_files();
    EXPECT_EQ(now(), "b");
}

TEST_F(EditsInForceTest, AreReadAnewWithOtherFiles) {
    edits.shown();
    edits.take(scene("a"));
    edits.forget_files();
    EXPECT_EQ(now(), "a");
    EXPECT_EQ(reads, 2);
    EXPECT_FALSE(edits.take_back()) << "the files may be at fault";
}

}  // namespace
}  // namespace lightnet::edits_in_force_test
