#include "instrumenter/edits.h"

#include <gtest/gtest.h>

namespace shadestep::instrumenter {
namespace {

using frontend::Token;
using frontend::TokenKind;
using frontend::TokenRange;

class EditsTest : public testing::Test {
 protected:
  EditsTest() {
    for (const char* text : {"a", "b", "c", "d"})
      tokens.push_back(Token{TokenKind::identifier, text, {1, 1}, false});
  }
  std::string applied(TokenRange range = {0, 3}) const {
    const auto result = edits.apply(range);
    if (const auto* conflict = std::get_if<EditConflict>(&result)) return "conflict: " + conflict->reason;
    std::string text;
    for (const Token& token : std::get<std::vector<Token>>(result)) text += token.text + " ";
    return text;
  }
  std::vector<Token> tokens;
  Edits edits{tokens};
};

TEST_F(EditsTest, ChangesNothingWithoutEdits) {
  EXPECT_EQ(applied(), "a b c d ");
}

TEST_F(EditsTest, WhatWasRegisteredEarlierIsOuter) {
  edits.wrap({1, 2}, "(", ")");
  edits.wrap({1, 2}, "[", "]");
  edits.insertBefore(1, "<");
  edits.insertAfter(2, ">");
  EXPECT_EQ(applied(), "a ( [ < b c > ] ) d ");
}

TEST_F(EditsTest, ARangeGetsOnePairOfBraces) {
  edits.insertAfter(2, "outside");
  edits.wrapInBraces({1, 2}, "(", ")");
  edits.wrapInBraces({1, 2}, "", "]");
  edits.wrapInBraces({2, 2}, "<", ">");
  EXPECT_EQ(applied(), "a { ( b { < c > } ] ) } outside d ");
}

TEST_F(EditsTest, WrapsOfAGapEncloseItsFilling) {
  edits.wrap({2, 1}, "(", ")");
  edits.wrap({2, 1}, "[", "]");
  edits.fill(2, "true");
  edits.insertAfter(1, "after");
  edits.insertBefore(2, "before");
  EXPECT_EQ(applied(), "a b after ( [ true ] ) before c d ");
}

TEST_F(EditsTest, ReplacesAndRemoves) {
  edits.replace(0, "x");
  edits.remove(2);
  EXPECT_EQ(applied(), "x b d ");
}

TEST_F(EditsTest, AppliesToARangeOnly) {
  edits.insertBefore(0, "x");
  edits.insertBefore(1, "y");
  EXPECT_EQ(applied({1, 2}), "y b c ");
}

TEST_F(EditsTest, ReplacementsOnlyDropInsertions) {
  edits.replace(0, "x");
  edits.insertBefore(1, "y");
  edits = edits.replacements();
  EXPECT_EQ(applied(), "x b c d ");
}

TEST_F(EditsTest, RefusesTwoReplacementsOfOneToken) {
  edits.replace(0, "x");
  edits.replace(0, "x");
  EXPECT_EQ(applied(), "x b c d ");
  edits.replace(0, "y");
  EXPECT_EQ(applied(), "conflict: it would be replaced by both 'x' and 'y'");
}

TEST_F(EditsTest, RefusesPlacesOutsideOfTheText) {
  edits.insertBefore(4, "x");
  EXPECT_EQ(applied(), "conflict: it points outside of the text");
}

TEST_F(EditsTest, InsertedTextStandsAtThePlaceOfItsAnchor) {
  tokens[2].place = {7, 3};
  edits.insertBefore(2, "x");
  const auto result = std::get<std::vector<Token>>(edits.apply({0, 3}));
  EXPECT_EQ(result[2].text, "x");
  EXPECT_EQ(result[2].place, (frontend::Place{7, 3}));
}

}  // namespace
}  // namespace shadestep::instrumenter
