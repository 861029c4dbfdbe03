// The nearest right word, for error messages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace drapeplan {

/// Smallest number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b` (the
/// optimal string alignment distance, in bytes).
int edit_distance(std::string_view a, std::string_view b);

/// The candidate with the smallest edit distance to `word`, or empty if none is similar enough to be meant
/// (more than a third of the longer word differs). Upper and lower case count as equal. One of the same
/// length wins a tie, then the first one.
std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates);

/// `"a", "b" or "c"`.
std::string alternatives_text(const std::vector<std::string>& words);

}  // namespace drapeplan
