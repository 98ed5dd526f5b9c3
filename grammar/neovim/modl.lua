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

--- Shows the lenses of a buffer again: they have changed when something was verified.
local function show_lenses(buffer)
  if vim.api.nvim_buf_is_loaded(buffer) then
    vim.lsp.codelens.refresh({ bufnr = buffer })
  end
end

--- Asks the server for a verdict, which a lens shows.
vim.lsp.commands["modl.verify"] = function(command, context)
  local client = vim.lsp.get_client_by_id(context.client_id)
  local asked = { command = command.command, arguments = command.arguments }
  client:request("workspace/executeCommand", asked, function(refused)
    if refused then
      vim.notify(refused.message, vim.log.levels.WARN)
    end
    show_lenses(context.bufnr)
  end, context.bufnr)
  vim.defer_fn(function() show_lenses(context.bufnr) end, 100)
end

vim.api.nvim_create_user_command("ModlVerify", function()
  local buffer = vim.api.nvim_get_current_buf()
  local client = vim.lsp.get_clients({ name = "modl", bufnr = buffer })[1]
  if client then
    local command = { command = "modl.verify", arguments = { vim.uri_from_bufnr(buffer) } }
    vim.lsp.commands["modl.verify"](command, { client_id = client.id, bufnr = buffer })
  end
end, { desc = "Verify the plans of this program" })

vim.api.nvim_create_autocmd("LspAttach", {
  callback = function(event)
    local client = vim.lsp.get_client_by_id(event.data.client_id)
    if not client or client.name ~= "modl" then
      return
    end
    vim.lsp.inlay_hint.enable(true, { bufnr = event.buf })
    show_lenses(event.buf)
    vim.api.nvim_create_autocmd({ "BufEnter", "InsertLeave", "TextChanged", "BufWritePost" }, {
      buffer = event.buf,
      callback = function() show_lenses(event.buf) end,
    })
  end,
})
