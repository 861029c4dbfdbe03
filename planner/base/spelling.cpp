#include "planner/base/spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace drapeplan {
namespace {

constexpr size_t kLongestWord = 80;  // beyond it nothing is a misspelling of a field name

std::string lower_case(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) c = char(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<int>> cost(a.size() + 1, std::vector<int>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) cost[i][0] = int(i);
  for (size_t j = 0; j <= b.size(); ++j) cost[0][j] = int(j);
  for (size_t i = 1; i <= a.size(); ++i) {
    for (size_t j = 1; j <= b.size(); ++j) {
      const int replace = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      cost[i][j] = std::min({replace, cost[i - 1][j] + 1, cost[i][j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  }
  return cost[a.size()][b.size()];
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  if (word.size() > kLongestWord) return {};
  const std::string wanted = lower_case(word);
  std::string nearest;
  int smallest = -1;
  for (const std::string& candidate : candidates) {
    const int distance = edit_distance(wanted, lower_case(candidate));
    const bool similar = 3 * distance <= int(std::max(word.size(), candidate.size()));
    const bool one_typing_error = distance == 1 && word.size() > 1;
    // Of equally near words, one of the same length is more often meant ("mn": "mm", not "m").
    const int rank = 2 * distance + (candidate.size() == word.size() ? 0 : 1);
    if ((similar || one_typing_error) && (smallest < 0 || rank < smallest)) {
      smallest = rank;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string alternatives_text(const std::vector<std::string>& words) {
  std::string text;
  for (size_t k = 0; k < words.size(); ++k) {
    if (k > 0) text += k + 1 == words.size() ? " or " : ", ";
    text += fmt::format("\"{}\"", words[k]);
  }
  return text;
}

}  // namespace drapeplan
