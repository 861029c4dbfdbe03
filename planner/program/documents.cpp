#include "planner/program/documents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "planner/cli/process.hpp"
#include "planner/program/command_line.hpp"

namespace drapeplan {
namespace {

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

/// "--out"
std::string name_of(const CLI::Option& option) {
  return option.get_lnames().empty() ? "" : "--" + option.get_lnames().front();
}

std::vector<const CLI::Option*> options_of(const CLI::App& app, bool positional) {
  return app.get_options(
      [positional](const CLI::Option* option) { return option->get_positional() == positional; });
}

/// Those that all verbs share stand in the man page once.
bool is_shared(const CLI::App& program, const std::string& name) {
  const std::vector<const CLI::App*> verbs = shown_verbs(program);
  return std::all_of(verbs.begin(), verbs.end(),
                     [&](const CLI::App* verb) { return verb->get_option_no_throw(name) != nullptr; });
}

/// Text as roff shows it: no escapes, no hyphens in place of minus signs, no line that begins a request.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n'))
      out += std::string("\\&") + c;
    else
      out += c;
  }
  return out;
}

std::string man_option(const CLI::Option& option) {
  std::string head = "\\fB" + roff(name_of(option)) + "\\fR";
  if (takes_value(option)) head += " \\fI" + roff(option.get_type_name()) + "\\fR";
  return ".TP\n" + head + "\n" + roff(option.get_description()) + "\n";
}

/// Commands as they are typed, each with its meaning.
std::string man_examples(const std::string& footer) {
  std::string text;
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("      "))
      text += roff(line.substr(6)) + "\n";
    else if (line.starts_with("  "))
      text += ".TP\n\\fB" + roff(line.substr(2)) + "\\fR\n";
  }
  return text;
}

std::string man_verb(const CLI::App& program, const CLI::App& verb) {
  std::string text = fmt::format(".SS \"{}", verb.get_name());
  for (const CLI::Option* option : options_of(verb, true))
    text += " " + option->get_name(true) + (option->get_items_expected_max() > 1 ? "..." : "");
  text += "\"\n" + roff(verb.get_description()) + ".\n";
  for (const CLI::Option* option : options_of(verb, true))
    text += ".TP\n\\fI" + roff(option->get_name(true)) + "\\fR\n" + roff(option->get_description()) + "\n";
  for (const CLI::Option* option : options_of(verb, false)) {
    if (!is_shared(program, name_of(*option))) text += man_option(*option);
  }
  return text + man_examples(verb.get_footer());
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options_of(app, false)) names.push_back(name_of(*option));
  return names;
}

/// Words in small letters of a placeholder such as "uniform|wave|FILE".
std::string words_in(const std::string& placeholder) {
  std::vector<std::string> words;
  std::istringstream parts(placeholder);
  for (std::string part; std::getline(parts, part, '|');) {
    if (!part.empty() && std::islower(static_cast<unsigned char>(part.front())) != 0) words.push_back(part);
  }
  return joined(words);
}

/// What stands behind an option or in place of an argument, as a call of one of the functions of the script.
std::string completer(const std::string& placeholder) {
  if (placeholder.ends_with("DIR")) return "_drapeplan_add -d";
  if (placeholder == "CASE" || placeholder == "TESTS") return "_drapeplan_documents";
  const std::string words = words_in(placeholder);
  if (placeholder.ends_with("FILE"))
    return words.empty() ? "_drapeplan_add -f" : "_drapeplan_add -f -W '" + words + "'";
  return words.empty() ? ":" : "_drapeplan_add -W '" + words + "'";
}

constexpr const char* kCompletionBegin = R"(_drapeplan_add() {
  local word
  while IFS= read -r word; do COMPREPLY+=("$word"); done < <(compgen "$@" -- "${COMP_WORDS[COMP_CWORD]}")
}
_drapeplan_documents() {
  _drapeplan_add -d
  _drapeplan_add -f -X '!*.json'
}
_drapeplan() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} verb=${COMP_WORDS[1]}
  COMPREPLY=()
)";

}  // namespace

std::string man_page(const CLI::App& program) {
  std::string text = fmt::format(
      ".TH DRAPEPLAN 1 \"\" \"drapeplan {}\" \"User Commands\"\n.SH NAME\ndrapeplan \\- plans robotic "
      "draping of woven "
      "prepreg plies\n.SH SYNOPSIS\n\\fBdrapeplan\\fR \\fIVERB\\fR [\\fIARGUMENTS\\fR] "
      "[\\fIOPTIONS\\fR]\n.SH "
      "DESCRIPTION\n{}\n.SH VERBS\n",
      DRAPEPLAN_VERSION, roff(program.get_description()));
  const std::vector<const CLI::App*> verbs = shown_verbs(program);
  for (const CLI::App* verb : verbs) text += man_verb(program, *verb);
  text += ".SH OPTIONS\nEvery verb takes these.\n";
  for (const CLI::Option* option : options_of(*verbs.front(), false)) {
    if (is_shared(program, name_of(*option))) text += man_option(*option);
  }
  text += ".SH \"EXIT STATUS\"\n";
  for (const auto& [code, meaning] :
       {std::pair{kDone, "done"},
        {kInputWrong, "the input is wrong: every error is listed, nothing is written"},
        {kNotFinished, "not finished: what was done is kept, and the reason is named"},
        {kBug, "a bug of the program"}})
    text += fmt::format(".TP\n{}\n{}\n", int(code), meaning);
  return text + ".SH EXAMPLES\n" + man_examples(program.get_footer());
}

std::string bash_completion(const CLI::App& program) {
  const std::vector<const CLI::App*> verbs = shown_verbs(program);
  std::vector<std::string> first;
  for (const CLI::App* verb : verbs) first.push_back(verb->get_name());
  for (const std::string& name : option_names(program)) first.push_back(name);
  std::string values, rest;
  for (const CLI::App* verb : verbs) {
    for (const CLI::Option* option : options_of(*verb, false)) {
      if (takes_value(*option))
        values += fmt::format("    {}:{}) {}; return ;;\n", verb->get_name(), name_of(*option),
                              completer(option->get_type_name()));
    }
    const std::vector<const CLI::Option*> arguments = options_of(*verb, true);
    rest += fmt::format("    {}:-*) _drapeplan_add -W '{}' ;;\n    {}:*) {} ;;\n", verb->get_name(),
                        joined(option_names(*verb)), verb->get_name(),
                        arguments.empty() ? ":" : completer(arguments.front()->get_name(true)));
  }
  return fmt::format(
      "# Completion of drapeplan {} in bash, made by `drapeplan completion`.\n{}"
      "  if [ \"$COMP_CWORD\" = 1 ]; then _drapeplan_add -W '{}'; return; fi\n"
      "  case $verb:$before in\n{}  esac\n  case $verb:$word in\n{}  esac\n}}\n"
      "complete -o filenames -F _drapeplan drapeplan\n",
      DRAPEPLAN_VERSION, kCompletionBegin, joined(first), values, rest);
}

void add_documents(CLI::App& program, Action& action) {
  const auto add = [&](const char* name, const char* what, std::string (*make)(const CLI::App&)) {
    CLI::App* verb = program.add_subcommand(name, what)->group("");
    verb->callback([&program, &action, make] {
      action = [&program, make] {
        print(make(program), false);
        return kDone;
      };
    });
  };
  add("man", "prints the man page", man_page);
  add("completion", "prints the completion for bash", bash_completion);
}

}  // namespace drapeplan
