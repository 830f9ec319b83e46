-- For figure5.lua: the paper's figure 5, each light operator in a thread of its own, those that have most to do twice
-- and behind a multiplexer.
--
--     image ─▶ lighting ─┬▶ direct
--                        ├▶ multiplexer ─┬▶ caustics
--                        │               └▶ caustics
--                        └▶ multiplexer ─┬▶ soft ─▶ first ─▶ direct, multiplexer of caustics, global
--                                        └▶ soft
place "here" { places = 1, image = 1, lighting = 1 }
place "here" { places = 1, direct = 1, first = 1 }
place "here" { places = 1, caustics = 1, global = 1 }
place "here" { places = 1, caustics = 1 }
place "here" { places = 2, soft = 2 }
