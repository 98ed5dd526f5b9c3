-- modl in Neovim 0.11: the language server, and the parser of `tree-sitter/` where it is installed as `parser/modl.so`.
-- Copy it to the folder `plugin` of the configuration, and `tree-sitter/queries/highlights.scm` to `queries/modl/`.

vim.filetype.add({ extension = { mod = "modl" } })

vim.lsp.config("modl", { cmd = { "modl", "lsp" }, filetypes = { "modl" } })
vim.lsp.enable("modl")

vim.api.nvim_create_autocmd("FileType", {
  pattern = "modl",
  callback = function(event)
    vim.bo[event.buf].commentstring = "// %s"
    vim.bo[event.buf].shiftwidth = 2
    vim.bo[event.buf].expandtab = true
    pcall(vim.treesitter.start, event.buf, "modl")
  end,
})

--- Runs `modl` on the program that is edited, in a terminal below it: a command of Neovim, and one of lenses.
local function on_program(name, lens, ...)
  local words = { "modl", ... }
  local function run()
    vim.cmd("silent write")
    local file = vim.fn.expand("%:p")
    local quoted = vim.tbl_map(vim.fn.shellescape, vim.list_extend(vim.list_slice(words), { file }))
    vim.cmd("botright split | terminal " .. table.concat(quoted, " "))
  end
  vim.api.nvim_create_user_command(name, run, { desc = table.concat(words, " ") .. " on this program" })
  vim.lsp.commands[lens] = run
end
on_program("ModlRun", "modl.run", "run")
on_program("ModlTest", "modl.test", "test")
on_program("ModlShow", "modl.show", "show", "--open")
