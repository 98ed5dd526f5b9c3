// What the grammar can't say by itself: block comments that nest, and `(`, `[`, `+`, `-` that go on with an expression because
// they stand on the line of its last token; and `ensure` before a condition, which elsewhere is a name.

#include "tree_sitter/parser.h"

enum Token { BLOCK_COMMENT, CALL, INDEX, PLUS, MINUS, ENSURE, NEVER };

void *tree_sitter_modl_external_scanner_create(void) { return 0; }
void tree_sitter_modl_external_scanner_destroy(void *payload) { (void)payload; }
unsigned tree_sitter_modl_external_scanner_serialize(void *payload, char *buffer) {
  (void)payload, (void)buffer;
  return 0;
}
void tree_sitter_modl_external_scanner_deserialize(void *payload, const char *buffer, unsigned length) {
  (void)payload, (void)buffer, (void)length;
}

// The rest of a comment whose `/` has been read.
static bool block_comment(TSLexer *lexer) {
  if (lexer->lookahead != '*') return false;
  lexer->advance(lexer, false);
  for (unsigned depth = 1; depth > 0;) {
    if (lexer->eof(lexer)) return false;
    int32_t first = lexer->lookahead;
    lexer->advance(lexer, false);
    if (first == '*' && lexer->lookahead == '/') {
      lexer->advance(lexer, false);
      depth--;
    } else if (first == '/' && lexer->lookahead == '*') {
      lexer->advance(lexer, false);
      depth++;
    }
  }
  lexer->result_symbol = BLOCK_COMMENT;
  return true;
}

static bool in_word(int32_t c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// Reads `word`, which no other character of words follows.
static bool is_word(TSLexer *lexer, const char *word) {
  for (; *word; word++) {
    if (lexer->lookahead != *word) return false;
    lexer->advance(lexer, false);
  }
  return !in_word(lexer->lookahead);
}

// `ensure` where the first word, number or text of a condition follows on its line.
static bool ensure(TSLexer *lexer) {
  if (!is_word(lexer, "ensure")) return false;
  lexer->mark_end(lexer);
  if (lexer->lookahead != ' ' && lexer->lookahead != '\t') return false;
  while (lexer->lookahead == ' ' || lexer->lookahead == '\t') lexer->advance(lexer, false);
  lexer->result_symbol = ENSURE;
  switch (lexer->lookahead) {
    case '"': return true;
    case 'a': return !is_word(lexer, "and");
    case 'o': return !is_word(lexer, "or");
    case 'w': return !is_word(lexer, "with");
    case 'i': return !is_word(lexer, "in");
    case 'e': return !is_word(lexer, "else");
    default: return in_word(lexer->lookahead);
  }
}

bool tree_sitter_modl_external_scanner_scan(void *payload, TSLexer *lexer, const bool *valid) {
  (void)payload;
  // While the parser recovers from an error, everything is valid.
  bool recovers = valid[NEVER];
  bool same_line = true;
  while (lexer->lookahead == ' ' || (lexer->lookahead >= '\t' && lexer->lookahead <= '\r')) {
    if (lexer->lookahead == '\n') same_line = false;
    lexer->advance(lexer, true);
  }
  int32_t found = lexer->lookahead;
  if (found == '/' && valid[BLOCK_COMMENT]) {
    lexer->advance(lexer, false);
    return block_comment(lexer);
  }
  if (recovers) return false;
  if (found == 'e' && valid[ENSURE]) return ensure(lexer);
  if (!same_line) return false;
  int token = found == '(' ? CALL : found == '[' ? INDEX : found == '+' ? PLUS : found == '-' ? MINUS : NEVER;
  if (token == NEVER || !valid[token]) return false;
  lexer->advance(lexer, false);
  if (token == PLUS && lexer->lookahead == '+') return false;
  if (token == MINUS && (lexer->lookahead == '-' || lexer->lookahead == '>')) return false;
  lexer->result_symbol = token;
  return true;
}
