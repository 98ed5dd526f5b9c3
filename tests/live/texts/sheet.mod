use std.mori.Mori
config Sheet { part a: Mori part b: Mori connect a.edge[0] -- b.edge[1] set a.edge[0].joint = 20deg }
