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

local function on_program(name, ...)
  local arguments = { ... }
  vim.api.nvim_create_user_command(name, function()
    vim.cmd.write()
    vim.cmd("botright split | terminal " .. table.concat(vim.tbl_map(vim.fn.shellescape, vim.list_extend({ "modl" }, arguments)), " ")
      .. " " .. vim.fn.shellescape(vim.fn.expand("%:p")))
  end, { desc = "modl " .. table.concat(arguments, " ") .. " on this program" })
end
on_program("ModlRun", "run")
on_program("ModlTest", "test")
on_program("ModlShow", "show", "--open")
