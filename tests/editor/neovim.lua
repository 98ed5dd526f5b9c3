-- Neovim with the configuration of `grammar/neovim`, as a person would use it. Writes what is wrong to standard output, a line
-- each, and nothing where all is well; the program is `main.mod` of the present folder.
--   nvim --clean --headless -c 'luafile .../modl.lua' -c 'edit main.mod' -c 'luafile .../neovim.lua'

local faults = {}
local PATIENCE = 20000

--- Waits until something holds; a fault otherwise.
local function wanted(what, holds)
  local fine, told = pcall(vim.wait, PATIENCE, holds, 20)
  if not fine or not told then
    table.insert(faults, "never: " .. what .. (fine and "" or " " .. tostring(told)))
  end
end

local function lines() return vim.api.nvim_buf_get_lines(0, 0, -1, false) end
local function text() return table.concat(lines(), "\n") .. "\n" end

--- Puts the cursor at the beginning of some words.
local function go_to(words)
  for row, line in ipairs(lines()) do
    local at = line:find(words, 1, true)
    if at then return vim.api.nvim_win_set_cursor(0, { row, at - 1 }) end
  end
  table.insert(faults, "no line has " .. words)
end

local function run()
  vim.fn.writefile({
    "use std.smores.Chain3",
    "config Worm {",
    "  part c: Chain3",
    "  behavior lift(a: Angle = 20deg) = c.half_wave(a)",
    "}",
    "let worm = Worm()",
    "let wrong = 1mm + 1s",
    'emit(worm.lift(), "worm.plan.json")',
  }, "main.mod")
  vim.cmd("edit! main.mod")
  wanted("the file type", function() return vim.bo.filetype == "modl" end)
  wanted("the server", function() return #vim.lsp.get_clients({ name = "modl", bufnr = 0 }) == 1 end)

  -- Diagnostics come, and go as the line goes.
  wanted("a diagnostic", function()
    local found = vim.diagnostic.get(0)
    return #found == 1 and found[1].code == "E0201" and found[1].lnum == 6
  end)
  vim.api.nvim_buf_set_lines(0, 6, 7, false, {})
  wanted("no diagnostic", function() return #vim.diagnostic.get(0) == 0 end)

  -- Completion, as the editor asks for it.
  vim.api.nvim_buf_set_lines(0, -1, -1, false, { "let more = worm." })
  local offered = {}
  -- Outside of insertion no cursor stands behind the last letter.
  local behind = { line = #lines() - 1, character = #"let more = worm." }
  local asked = { textDocument = { uri = vim.uri_from_bufnr(0) }, position = behind }
  for _, answer in pairs(vim.lsp.buf_request_sync(0, "textDocument/completion", asked, 5000) or {}) do
    for _, item in ipairs(answer.result or {}) do offered[item.label] = true end
  end
  if not (offered.lift and offered.c) then table.insert(faults, "candidates: " .. vim.inspect(offered)) end
  vim.api.nvim_buf_set_lines(0, -2, -1, false, {})

  -- A rename changes all uses, and formatting lays out.
  go_to("worm = Worm")
  vim.lsp.buf.rename("snake")
  wanted("the new name", function() return text():find("let snake = Worm()", 1, true) and text():find("emit(snake.lift()", 1, true) end)
  go_to("let snake")
  vim.api.nvim_set_current_line("let   snake=Worm()")
  vim.lsp.buf.format({ timeout_ms = 5000 })
  wanted("the layout", function() return text():find("let snake = Worm()\n", 1, true) end)

  -- Hover.
  go_to("Worm()")
  local answers = vim.lsp.buf_request_sync(0, "textDocument/hover", vim.lsp.util.make_position_params(0, "utf-16"), 5000) or {}
  local _, hover = next(answers)
  if not (hover and hover.result and hover.result.contents.value:find("config Worm", 1, true)) then
    table.insert(faults, "hover: " .. vim.inspect(answers))
  end

  -- A lens gives the verdict its place.
  local function lens(words)
    for _, one in ipairs(vim.lsp.codelens.get(0)) do
      if one.command and one.command.title:find(words, 1, true) then return one end
    end
  end
  wanted("the lens", function() return lens("Verify") end)
  vim.cmd("ModlVerify")
  wanted("the verdict", function() return lens("verified under full dynamics, least margin") end)
end

local fine, why = xpcall(run, debug.traceback)
if not fine then table.insert(faults, tostring(why)) end
io.stdout:write(table.concat(faults, "\n"))
vim.cmd(#faults > 0 and "cquit! 1" or "qall!")
