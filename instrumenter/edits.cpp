#include "instrumenter/edits.h"

#include <ranges>

namespace shadestep::instrumenter {

using frontend::Token;
using frontend::TokenIndex;
using frontend::TokenKind;
using frontend::TokenRange;

void Edits::wrap(TokenRange range, std::string open, std::string close) {
  if (!range.empty()) {
    insertBefore(range.first, std::move(open));
    insertAfter(range.last, std::move(close));
    return;
  }
  if (Slot* at = slot(range.first)) {
    at->gap_open.push_back(textAt(range.first, std::move(open)));
    at->gap_close.push_back(textAt(range.first, std::move(close)));
  }
}

void Edits::wrapInBraces(TokenRange range, std::string open, std::string close) {
  const bool first = braced_.insert(range.first).second;
  wrap(range, first ? "{ " + open : std::move(open), first ? close + " }" : std::move(close));
}

void Edits::insertBefore(TokenIndex token, std::string text) {
  insertBefore(token, textAt(token, std::move(text)));
}

void Edits::insertAfter(TokenIndex token, std::string text) {
  insertAfter(token, textAt(token, std::move(text)));
}

void Edits::insertBefore(TokenIndex token, std::vector<Token> tokens) {
  if (Slot* at = slot(token)) at->before.push_back(std::move(tokens));
}

void Edits::insertAfter(TokenIndex token, std::vector<Token> tokens) {
  if (Slot* at = slot(token)) at->after.push_back(std::move(tokens));
}

void Edits::fill(TokenIndex token, std::string text) {
  if (Slot* at = slot(token)) at->gap_fill = std::move(text);
}

void Edits::replace(TokenIndex token, std::string text) {
  Slot* at = slot(token);
  if (!at) return;
  if (at->replacement && *at->replacement != text && !conflict_)
    conflict_ =
        EditConflict{token, "it would be replaced by both '" + *at->replacement + "' and '" + text + "'"};
  at->replacement = std::move(text);
}

Edits Edits::replacements() const {
  Edits only(*tokens_);
  for (const auto& [token, slot] : slots_)
    if (slot.replacement) only.replace(token, *slot.replacement);
  return only;
}

std::variant<std::vector<Token>, EditConflict> Edits::apply(TokenRange range) const {
  if (conflict_) return *conflict_;
  Tokens result;
  const auto append = [&result](const Tokens& tokens) {
    result.insert(result.end(), tokens.begin(), tokens.end());
  };
  for (TokenIndex i = range.first; i <= range.last; ++i) {
    const Token& token = (*tokens_)[static_cast<std::size_t>(i)];
    const auto found = slots_.find(i);
    if (found == slots_.end()) {
      result.push_back(token);
      continue;
    }
    const Slot& at = found->second;
    for (const Tokens& open : at.gap_open) append(open);
    append(textAt(i, at.gap_fill));
    for (const Tokens& close : std::views::reverse(at.gap_close)) append(close);
    for (const Tokens& text : at.before) append(text);
    if (!at.replacement) {
      result.push_back(token);
    } else if (!at.replacement->empty()) {
      result.push_back(token);
      result.back().text = *at.replacement;
    }
    for (const Tokens& text : std::views::reverse(at.after)) append(text);
  }
  return result;
}

Edits::Slot* Edits::slot(TokenIndex token) {
  if (token >= 0 && static_cast<std::size_t>(token) < tokens_->size()) return &slots_[token];
  if (!conflict_) conflict_ = EditConflict{token, "it points outside of the text"};
  return nullptr;
}

Edits::Tokens Edits::textAt(TokenIndex token, std::string text) const {
  if (text.empty() || token < 0 || static_cast<std::size_t>(token) >= tokens_->size()) return {};
  return {Token{TokenKind::identifier, std::move(text), (*tokens_)[static_cast<std::size_t>(token)].place,
                false}};
}

}  // namespace shadestep::instrumenter
